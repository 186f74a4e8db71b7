// SPDX-License-Identifier: AGPL-3.0-or-later
/// Reproducible=on: a picture that depends on no thread count, no cut into strips, no order and no frame rendered before.
/// What would carry something from one pixel to the next starts anew at each (pixelstreams.cpp); what is shot before
/// the first pixel (photons, radiosity's pretrace) is shot by one thread and for the whole frame, whatever part of it is asked for.
#ifndef POVRAY_REPRODUCIBLE_H
#define POVRAY_REPRODUCIBLE_H

#include <set>
#include <string>
#include <vector>

#include "backend/frame.h"
#include "backend/render/trace.h"
#include "backend/support/taskqueue.h"
#include "base/povmscpp.h"

namespace pov
{

class RadiosityCache;
class SceneData;
class ViewData;

/// A scene has one while it is rendered reproducibly, else none. The hooks' functions do nothing without.
class Reproducible
{
	public:
		/// Called when a view's options are known, before its first task. Serial numbers `done` and `first` are of blocks
		/// that +C need not render again; `threads` becomes the number for photons and the pretrace. Mosaic previews and
		/// High_Reproducibility are turned off: all they change is what is shown before the end, and what we do better.
		/// Returns how many threads may trace. Throws a pov_base::Exception about a radiosity file that is not whole.
		static int Prepare(ViewData& view, POVMS_Object& options, shared_ptr<std::set<unsigned int> > done, unsigned int& first,
		                   unsigned int tracing_method, unsigned int& preview_start, bool& high, int& threads);
		/// Called after the last task before tracing was appended; returns `tracing_threads`.
		static int Before_Trace(ViewData& view, TaskQueue& tasks, int tracing_threads);
		/// A camera ray starts at x, y (pixels, with the fractions of antialiasing).
		///   interiors  to be set when the objects around the camera must be found again, as it `moves`
		static void Begin_Pixel(const Reproducible *r, Trace& trace, DBL x, DBL y, bool moves, bool& interiors)
		{
			if(r != NULL)
				r->Begin(trace, x, y, moves, interiors);
		}
		/// Whether radiosity samples taken in this pass (OT_PASS_...) are kept for other pixels.
		static bool Keeps_Samples(const Trace& trace, unsigned int pass);
		/// Takes from a block's pixels (five numbers each) and its message what is outside of the strip.
		static void Crop(const SceneData& scene, const POVRect& block, const std::vector<POVMSFloat>& pixels, POVMS_Message& message);
	private:
		POVRect strip;                               // what is asked for
		POVRect traced;                              // with whole blocks where antialiasing looks at neighbours in the block
		int block_step;                              // Render_Block_Step as asked for
		unsigned int block_size;
		shared_ptr<std::set<unsigned int> > done;
		unsigned int first;
		std::string radiosity_file;                  // to be written after the pretrace; or empty

		void Set_Area(ViewData& view, const POVRect& area, const std::set<unsigned int>& skip, unsigned int next) const;
		void Enter_Strip(ViewData *view, TaskQueue&) const;
		void Prepare_Radiosity(ViewData& view, POVMS_Object& options, const POVRect& frame);
		void Begin(Trace& trace, DBL x, DBL y, bool moves, bool& interiors) const;
		static void Seed(Trace& trace, Trace::MediaFunctor& media, POV_ULONG seed);
		static bool Load(RadiosityCache& cache, const std::string& file);
		static bool Save(const RadiosityCache& cache, const std::string& file);
};

}

#endif
