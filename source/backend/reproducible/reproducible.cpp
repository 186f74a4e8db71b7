// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdlib>
#include <numeric>

#include <boost/bind.hpp>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/control/messagefactory.h"
#include "backend/scene/view.h"
#include "backend/shape/isosurf.h"
#include "backend/reproducible/options.h"
#include "backend/reproducible/reproducible.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

// An isosurface with `evaluate` learns its max_gradient while it is rendered: what a pixel shows depends on those before it.
static bool Learns(const vector<ObjectPtr>& objects)
{
	for(vector<ObjectPtr>::const_iterator i = objects.begin(); i != objects.end(); i++)
	{
		const IsoSurface *surface = dynamic_cast<const IsoSurface *>(*i);
		const CompoundObject *compound = dynamic_cast<const CompoundObject *>(*i);
		if(((surface != NULL) && surface->eval) || ((compound != NULL) && Learns(compound->children)) || Learns((*i)->Clip))
			return true;
	}
	return false;
}

int Reproducible::Prepare(ViewData& view, POVMS_Object& options, shared_ptr<std::set<unsigned int> > done, unsigned int& first,
                          unsigned int tracing_method, unsigned int& preview_start, bool& high, int& threads)
{
	SceneData& scene = *view.sceneData;
	const int tracing_threads = threads;

	scene.reproducible.reset();
	if(options.Exist(kPOVAttrib_PixelsFromFile))
	{
		// The front end has the pixels: no photons, no radiosity, no blocks.
		scene.photonSettings.photonsEnabled = scene.radiositySettings.radiosityEnabled = false;
		view.SetNextRectangle(*done, first = view.blockWidth * view.blockHeight);
		preview_start = 1;
		return tracing_threads;
	}
	if(!options.TryGetBool(kPOVAttrib_Reproducible, false))
		return tracing_threads;

	const POVRect frame(0, 0, view.width - 1, view.height - 1);
	shared_ptr<Reproducible> r(new Reproducible());
	r->strip = r->traced = view.renderArea;
	r->block_size = std::min(std::max(options.TryGetInt(kPOVAttrib_RenderBlockSize, 32), 4), int(std::max(view.width, view.height)));
	r->block_step = options.TryGetInt(kPOVAttrib_RenderBlockStep, 0);
	r->done = done;
	r->first = first;
	// +AM1 looks at a pixel's neighbours as far as its block goes: blocks are the frame's, and traced whole.
	if((tracing_method == 1) && (r->strip.top <= r->strip.bottom) && (r->strip.left <= r->strip.right))
	{
		r->traced.left -= r->traced.left % r->block_size;
		r->traced.top -= r->traced.top % r->block_size;
		r->traced.right = std::min(frame.right, r->traced.right - r->traced.right % r->block_size + r->block_size - 1);
		r->traced.bottom = std::min(frame.bottom, r->traced.bottom - r->traced.bottom % r->block_size + r->block_size - 1);
	}
	// The photon map's radius is found by rand(), which goes on from the frame before.
	srand(1);
	preview_start = 1;
	high = false;
	threads = 1;
	scene.reproducible = r;
	r->Set_Area(view, r->traced, *done, first);
	if(scene.radiositySettings.radiosityEnabled)
		r->Prepare_Radiosity(view, options, frame);
	if(!Learns(scene.objects))
		return tracing_threads;
	MessageFactory(10, 370, "Render", scene.backendAddress, scene.frontendAddress, scene.sceneId, view.viewId).Warning(0,
		"An isosurface has 'evaluate': it learns from pixel to pixel. One thread renders it; strips may not fit together.");
	return 1;
}

void Reproducible::Set_Area(ViewData& view, const POVRect& area, const std::set<unsigned int>& skip, unsigned int next) const
{
	view.renderArea = area;
	view.blockSize = block_size;
	view.blockWidth = (area.GetWidth() + block_size - 1) / block_size;
	view.blockHeight = (area.GetHeight() + block_size - 1) / block_size;
	view.blockInfoList.assign(view.blockWidth * view.blockHeight, NULL);
	const unsigned int blocks = std::max(1u, view.blockWidth * view.blockHeight);
	view.renderBlockStep = 0;
	if(block_step > 0)
	{
		// As stock has it: no common divisor, or not every block would be rendered.
		view.renderBlockStep = (block_step % blocks != 0) ? block_step % blocks : blocks;
		while(std::gcd(view.renderBlockStep, blocks) > 1)
			view.renderBlockStep--;
	}
	view.SetNextRectangle(skip, next);
}

void Reproducible::Prepare_Radiosity(ViewData& view, POVMS_Object& options, const POVRect& frame)
{
	SceneRadiositySettings& settings = view.sceneData->radiositySettings;
	const bool load = options.TryGetBool(kPOVAttrib_RadiosityFromFile, false), save = options.TryGetBool(kPOVAttrib_RadiosityToFile, false);
	const std::string file = UCS2toASCIIString(options.TryGetUCS2String(kPOVAttrib_RadiosityFileName, "object.rca"));

	// Stock is about to write its own file, which is rounded.
	if(view.radiosityCache.ot_fd != NULL)
	{
		view.radiosityCache.ot_fd->close();
		delete view.radiosityCache.ot_fd;
		view.radiosityCache.ot_fd = NULL;
	}
	// Nothing is added to the cache while tracing, so what was found near enough has to do.
	settings.alwaysSample = false;
	if(load && Load(view.radiosityCache, file))
	{
		// StartRender's count of steps from one to the other comes to none; less would be taken for very many.
		settings.pretraceStart = 0.35;
		settings.pretraceEnd = 1.0;
		return;
	}
	if(save)
		radiosity_file = file;
	Set_Area(view, frame, std::set<unsigned int>(), 0);
}

int Reproducible::Before_Trace(ViewData& view, TaskQueue& tasks, int tracing_threads)
{
	if(view.sceneData->reproducible)
	{
		tasks.AppendFunction(boost::bind(&Reproducible::Enter_Strip, view.sceneData->reproducible, &view, _1));
		tasks.AppendSync();
	}
	return tracing_threads;
}

void Reproducible::Enter_Strip(ViewData *view, TaskQueue&) const
{
	if(!radiosity_file.empty() && !Save(view->radiosityCache, radiosity_file))
		MessageFactory(10, 370, "Render", view->sceneData->backendAddress, view->sceneData->frontendAddress, view->sceneData->sceneId,
		               view->viewId).Warning(0, "Radiosity_File_Name=%s: cannot be written; the picture does not need it.", radiosity_file.c_str());
	Set_Area(*view, traced, *done, first);
}

void Reproducible::Crop(const SceneData& scene, const POVRect& block, const std::vector<POVMSFloat>& pixels, POVMS_Message& message)
{
	if(!scene.reproducible)
		return;
	const POVRect& strip = scene.reproducible->strip;
	const POVRect shown(std::max(block.left, strip.left), std::max(block.top, strip.top), std::min(block.right, strip.right), std::min(block.bottom, strip.bottom));
	if(shown.GetArea() == block.GetArea())
		return;

	std::vector<POVMSFloat> rest;
	for(unsigned int y = shown.top; y <= shown.bottom; y++)
	{
		const std::vector<POVMSFloat>::const_iterator row = pixels.begin() + size_t(y - block.top) * block.GetWidth() * 5;
		rest.insert(rest.end(), row + (shown.left - block.left) * 5, row + (shown.right - block.left + 1) * 5);
	}
	POVMS_Attribute attribute(rest);
	message.Set(kPOVAttrib_PixelBlock, attribute);
	message.SetInt(kPOVAttrib_Left, shown.left);
	message.SetInt(kPOVAttrib_Top, shown.top);
	message.SetInt(kPOVAttrib_Right, shown.right);
	message.SetInt(kPOVAttrib_Bottom, shown.bottom);
}

}
