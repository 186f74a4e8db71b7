// SPDX-License-Identifier: AGPL-3.0-or-later
/// The parser's part: `blackhole { ... }`, where it may stand, and what is wrong with it.
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/matrices.h"
#include "backend/math/vector.h"
#include "backend/parser/parse.h"
#include "backend/scene/scene.h"
#include "backend/shape/csg.h"
#include "backend/blackhole/blackholes.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

static const double BLACKHOLE_VERSION = 1.0;

// A switch is a float as all of POV-Ray's are: on, yes, true or any number but zero.
static bool Is_On(DBL value)
{
	return fabs(value) > EPSILON;
}

void Parser::Predeclare_Blackhole()
{
	SYM_ENTRY *entry = Add_Symbol(1, "Blackhole_Version", FLOAT_ID_TOKEN);
	entry->Data = Create_Float();
	*((DBL *)(entry->Data)) = BLACKHOLE_VERSION;
}

ObjectPtr Parser::Parse_Blackhole()
{
	Parse_Begin();

	if(ObjectPtr object = Parse_Object_Id())
		return object;

	Blackhole *hole = new Blackhole();
	hole->File = Token.FileHandle->name();
	hole->Line = Token.Token_File_Pos.lineno;

	Parse_Vector(hole->Center);
	Parse_Comma();
	hole->Radius = Parse_Float();
	Check_Blackhole(*hole);
	hole->Compute_BBox();

	return Parse_Blackhole_Mods(hole);
}

// Options and transformations, in any order, in `blackhole { ... }` and in `object { Hole ... }`, to the closing brace.
ObjectPtr Parser::Parse_Blackhole_Mods(ObjectPtr object)
{
	Blackhole *hole = dynamic_cast<Blackhole *>(object);
	VECTOR vector;
	MATRIX matrix;
	TRANSFORM transform;

	EXPECT
		CASE(EFFECT_RADIUS_TOKEN)
			hole->Effect_Radius = Parse_Float();
			if(!(hole->Effect_Radius > 1.5 * hole->Radius) || !(hole->Effect_Radius <= 1e15))
				Error("blackhole: effect_radius must exceed 1.5 times the Schwarzschild radius (%g), and be below 1e15; it is %g.", 1.5 * hole->Radius, hole->Effect_Radius);
		END_CASE

		CASE(TOLERANCE_TOKEN)
			hole->Tolerance = Parse_Float();
			if(!((hole->Tolerance >= 1e-9) && (hole->Tolerance <= 0.1)))
				Error("blackhole: tolerance must be between 1e-9 and 0.1 radians; it is %g.", hole->Tolerance);
		END_CASE

		CASE(METHOD_TOKEN)
		{
			char *name = Parse_C_String();
			const bool known = blackhole::find_method(name, hole->Method);
			const string given(name);
			POV_FREE(name);
			if(!known)
			{
				string list;
				for(size_t i = 0; i < sizeof(blackhole::method_names) / sizeof(*blackhole::method_names); i++)
					list += string(i > 0 ? ", \"" : "\"") + blackhole::method_names[i] + "\"";
				Error("blackhole: unknown method \"%s\"; known: %s.", given.c_str(), list.c_str());
			}
		}
		END_CASE

		CASE(CAMERA_TOKEN)
		{
			char *name = Parse_C_String();
			const string given(name);
			POV_FREE(name);
			if(given == "static")
				hole->Camera = Blackhole::STATIC_CAMERA;
			else if(given == "falling")
				hole->Camera = Blackhole::FALLING_CAMERA;
			else if(given == "coordinate")
				hole->Camera = Blackhole::COORDINATE_CAMERA;
			else
				Error("blackhole: unknown camera \"%s\"; known: \"static\", \"falling\", \"coordinate\".", given.c_str());
		}
		END_CASE

		CASE(BEND_LIGHTS_TOKEN)
			if(Is_On(Parse_Float()))
				Warning(0, "blackhole: bend_lights is not there yet; light goes straight.");
		END_CASE

		CASE(TRANSLATE_TOKEN)
			Parse_Vector(vector);
			Compute_Translation_Transform(&transform, vector);
			hole->Translate(vector, &transform);
			Check_Blackhole(*hole);
		END_CASE

		CASE(ROTATE_TOKEN)
			Parse_Vector(vector);
			Compute_Rotation_Transform(&transform, vector);
			hole->Rotate(vector, &transform);
		END_CASE

		CASE(SCALE_TOKEN)
			Parse_Scale_Vector(vector);
			Compute_Scaling_Transform(&transform, vector);
			hole->Scale(vector, &transform);
			Check_Blackhole(*hole);
		END_CASE

		CASE(TRANSFORM_TOKEN)
			hole->Transform(Parse_Transform(&transform));
			Check_Blackhole(*hole);
		END_CASE

		CASE(MATRIX_TOKEN)
			Parse_Matrix(matrix);
			Compute_Matrix_Transform(&transform, matrix);
			hole->Transform(&transform);
			Check_Blackhole(*hole);
		END_CASE

		CASE6(TEXTURE_TOKEN, PIGMENT_TOKEN, TNORMAL_TOKEN, FINISH_TOKEN, MATERIAL_TOKEN, INTERIOR_TOKEN)
			Error("A blackhole has no texture and no interior: it is black, and what is around it is the scene's.");
		END_CASE

		CASE2(BOUNDED_BY_TOKEN, CLIPPED_BY_TOKEN)
			Error("A blackhole cannot be bounded or clipped; effect_radius says how far it reaches.");
		END_CASE

		CASE(RIGHT_CURLY_TOKEN)
			UNGET
			EXIT
		END_CASE

		OTHERWISE
			UNGET
			Expectation_Error("effect_radius, tolerance, method, camera, bend_lights, a transformation or }");
			EXIT
		END_CASE
	END_EXPECT

	Parse_End();
	return hole;
}

void Parser::Check_Blackhole(const Blackhole& hole)
{
	for(int i = X; i <= Z; i++)
		if(!(fabs(hole.Center[i]) <= BOUND_HUGE))
			Error("blackhole: the centre must be a point, not <%g,%g,%g>.", hole.Center[X], hole.Center[Y], hole.Center[Z]);
	if(hole.Distorted)
		Error("A blackhole is round: only moves, rotations and uniform scales can transform it.");
	if(!((hole.Radius >= 1e-9) && (hole.Radius <= 1e9)))
		Error("blackhole: the Schwarzschild radius must be between 1e-9 and 1e9; it is %g.", hole.Radius);
	if(!(hole.Reach() <= 1e15 * hole.Radius))
		Error("blackhole: effect_radius must be at most 1e15 times the Schwarzschild radius (%g); it is %g.", 1e15 * hole.Radius, hole.Reach());
}

void Parser::Check_No_Blackhole(ObjectPtr object, const char *where)
{
	if(Is_Blackhole(object))
		Error("A blackhole cannot be part of %s: it has no inside, no outside and no surface. It may stand in a union.", where);
	// A hole in a union in an intersection is in that intersection all the same.
	if(CSG *csg = dynamic_cast<CSG *>(object))
		for(size_t i = 0; i < csg->children.size(); i++)
			Check_No_Blackhole(csg->children[i], where);
}

bool Parser::Is_Blackhole(ObjectPtr object)
{
	return dynamic_cast<Blackhole *>(object) != NULL;
}

// Takes the holes out of an object that joins the scene. True if nothing of it remains.
bool Parser::Link_Blackholes(ObjectPtr object)
{
	if(Blackhole *hole = dynamic_cast<Blackhole *>(object))
	{
		Blackholes& holes = *sceneData->blackHoles;
		Check_Blackhole(*hole);
		if(!holes.Enabled())
		{
			Destroy_Object(hole);
			return true;
		}
		holes.Overrides().Apply(*hole);
		if(const Blackhole *other = holes.Overlapping(*hole))
		{
			const DBL fit = 0.5 * other->Distance(hole->Center);
			Error("The effect spheres of the black holes at <%g,%g,%g> (radius %g) and <%g,%g,%g> (radius %g) overlap; their largest radii that fit are %g each.",
			      other->Center[X], other->Center[Y], other->Center[Z], other->Reach(), hole->Center[X], hole->Center[Y], hole->Center[Z], hole->Reach(), fit);
		}
		if((hole->Camera == Blackhole::FALLING_CAMERA) && (holes.Falling() != NULL))
			Error("Only one black hole can have camera \"falling\": the one at <%g,%g,%g> has it.", holes.Falling()->Center[X], holes.Falling()->Center[Y], holes.Falling()->Center[Z]);
		holes.Add(hole);
		return true;
	}
	CSG *csg = dynamic_cast<CSG *>(object);
	if(csg == NULL)
		return false;
	if(dynamic_cast<CSGIntersection *>(object) != NULL)
	{
		// Others were refused when they were made: this is a union turned inside out.
		Check_No_Blackhole(object, "an inverse union");
		return false;
	}
	bool found = false;
	if(!csg->Clip.empty())
		Check_No_Blackhole(csg, "what is clipped");
	for(size_t i = 0; i < csg->children.size(); )
	{
		if(Link_Blackholes(csg->children[i]))
		{
			csg->children.erase(csg->children.begin() + i);
			found = true;
		}
		else
			i++;
	}
	if(!found || !csg->children.empty())
		return false;
	Destroy_Object(csg);
	return true;
}

bool Parser::Has_Blackholes() const
{
	return !sceneData->blackHoles->Holes().empty();
}

// When everything is parsed: what can only be said of the whole scene.
void Parser::Finish_Blackholes()
{
	Blackholes& holes = *sceneData->blackHoles;
	for(size_t i = 0; i < holes.Holes().size(); i++)
	{
		const Blackhole& hole = *holes.Holes()[i];
		if(sceneData->parsedCamera.Type == MESH_CAMERA) // its location says nothing
			break;
		const DBL r = hole.Distance(sceneData->parsedCamera.Location);
		string problem;
		if(!(r < 1e30))
			problem = "the camera's location is not a point; look for a division by zero";
		else if(r == 0.0)
			problem = "the camera is at its centre, where nothing is; move the camera";
		else if((r <= hole.Radius) && (hole.Camera != Blackhole::FALLING_CAMERA))
			problem = string("the camera is at or inside the horizon, where no ") + (hole.Camera == Blackhole::STATIC_CAMERA ? "static" : "coordinate") +
			          " observer can be; use camera \"falling\"";
		if(!problem.empty())
			messageFactory.ErrorAt(POV_EXCEPTION(kParseErr, problem), hole.File.c_str(), hole.Line, 0, 0,
			                       "Black hole at <%g,%g,%g>: %s.", hole.Center[X], hole.Center[Y], hole.Center[Z], problem.c_str());
	}
	const string report = holes.Prepare(*sceneData, GetParserDataPtr(), messageFactory);
	if(!report.empty())
	{
		Debug_Message_Buffer.printf("%s", report.c_str());
		Debug_Message_Buffer.flush();
	}
}

}
