// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <string>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "base/stringutilities.h"
#include "backend/blackhole/blackhole.h"
#include "backend/blackhole/options.h"
#include "backend/blackhole/overrides.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

// 0 if the key is not there. In range: above least, or that very value if it may be taken, up to most.
static DBL Number(POVMS_Object& options, POVMSType key, const char *name, DBL least, bool taken, DBL most, const char *right)
{
	const std::string given = UCS2toASCIIString(options.TryGetUCS2String(key, ""));
	if(given.empty())
		return 0.0;
	char *end = NULL;
	const DBL value = strtod(given.c_str(), &end);
	if((*end != 0) || !((value > least) || (taken && (value == least))) || !(value <= most))
		throw POV_EXCEPTION(kParamErr, std::string(name) + "=" + given + ": must be " + right);
	return value;
}

Hole_Overrides::Hole_Overrides(POVMS_Object& options) :
	tolerance(Number(options, kPOVAttrib_BlackholeTolerance, "Blackhole_Tolerance", 1e-9, true, 0.1, "between 1e-9 and 0.1 radians")),
	effect_radius(Number(options, kPOVAttrib_BlackholeEffectRadius, "Blackhole_Effect_Radius", 1.5, false, 1e12, "above 1.5 Schwarzschild radii, and at most 1e12")),
	has_method(false),
	method(blackhole::Method::rk4)
{
	const std::string name = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_BlackholeMethod, ""));
	has_method = !name.empty();
	if(!has_method || blackhole::find_method(name.c_str(), method))
		return;
	std::string known;
	for(size_t i = 0; i < sizeof(blackhole::method_names) / sizeof(*blackhole::method_names); i++)
		known += std::string(i > 0 ? ", " : "") + blackhole::method_names[i];
	throw POV_EXCEPTION(kParamErr, "Blackhole_Method=" + name + ": must be one of " + known);
}

void Hole_Overrides::Apply(Blackhole& hole) const
{
	if(tolerance > 0.0)
		hole.Tolerance = tolerance;
	if(effect_radius > 0.0)
		hole.Effect_Radius = min(effect_radius * hole.Radius, 1e15);
	if(has_method)
		hole.Method = method;
}

}
