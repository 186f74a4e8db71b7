// SPDX-License-Identifier: AGPL-3.0-or-later
/// INI keys of ours and their attributes, shared by the front end that reads them and the back end that obeys.
/// The codes are ours alone: POV-Ray's povmsgid.h has none of them.
#ifndef POVRAY_BLACKHOLE_OPTIONS_H
#define POVRAY_BLACKHOLE_OPTIONS_H

enum
{
	kPOVAttrib_Blackhole           = 'BkHl', ///< bool: off renders the scene without its holes
	kPOVAttrib_RayPaths            = 'RyPa', ///< file to write the traced chords to
	kPOVAttrib_RayPathsGrid        = 'RyPG', ///< "32x24": rays across and down the picture
	kPOVAttrib_RayEnds             = 'RyEn', ///< file to write each pixel's ray ends to
	kPOVAttrib_SampleBlocks        = 'SmBl', ///< one block in so many is rendered
	kPOVAttrib_BlackholeTolerance  = 'BkTo', ///< overrides every hole's, radians
	kPOVAttrib_BlackholeMethod     = 'BkMe', ///< likewise, a name
	kPOVAttrib_BlackholeEffectRadius = 'BkER', ///< likewise, in Schwarzschild radii
	kPOVAttrib_BlackholeStatistics = 'BkSt'  ///< lines for the statistics block
};

#define BLACKHOLE_INI_KEYS \
	{ "Blackhole",           kPOVAttrib_Blackhole,          kPOVMSType_Bool }, \
	{ "Blackhole_Effect_Radius", kPOVAttrib_BlackholeEffectRadius, kPOVMSType_UCS2String }, \
	{ "Blackhole_Method",    kPOVAttrib_BlackholeMethod,    kPOVMSType_UCS2String }, \
	{ "Blackhole_Tolerance", kPOVAttrib_BlackholeTolerance, kPOVMSType_UCS2String }, \
	{ "Ray_Ends",            kPOVAttrib_RayEnds,            kPOVMSType_UCS2String }, \
	{ "Ray_Paths",           kPOVAttrib_RayPaths,           kPOVMSType_UCS2String }, \
	{ "Ray_Paths_Grid",      kPOVAttrib_RayPathsGrid,       kPOVMSType_UCS2String }, \
	{ "Sample_Blocks",       kPOVAttrib_SampleBlocks,       kPOVMSType_UCS2String },

#endif
