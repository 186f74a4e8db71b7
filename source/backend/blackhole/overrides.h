// SPDX-License-Identifier: AGPL-3.0-or-later
/// INI keys that set what a scene's holes say of themselves: a preview, or a trial, without an edit.
#ifndef POVRAY_BLACKHOLE_OVERRIDES_H
#define POVRAY_BLACKHOLE_OVERRIDES_H

#include "base/povms.h"
#include "base/povmscpp.h"
#include "blackhole/path.h"

namespace pov
{

class Blackhole;

class Hole_Overrides
{
	public:
		/// Reads `Blackhole_Tolerance` (radians, 1e-9 to 0.1), `Blackhole_Method` (a name) and `Blackhole_Effect_Radius` (in
		/// Schwarzschild radii, above 1.5, up to 1e12). Throws on anything else.
		explicit Hole_Overrides(POVMS_Object& options);
		/// Sets what is wanted. A radius beyond 1e15 scene units becomes that, the most a scene may say.
		void Apply(Blackhole& hole) const;
	private:
		DBL tolerance, effect_radius; ///< 0: as the scene has it
		bool has_method;
		blackhole::Method method;
};

}

#endif
