// SPDX-License-Identifier: AGPL-3.0-or-later
/// INI keys of pictures made in pieces, shared by the front end that reads them and the back end that obeys.
/// The codes are ours alone: POV-Ray's povmsgid.h has none of them.
#ifndef POVRAY_REPRODUCIBLE_OPTIONS_H
#define POVRAY_REPRODUCIBLE_OPTIONS_H

enum
{
	kPOVAttrib_Reproducible   = 'Repr', ///< bool: a pixel depends on no thread, no strip and no frame before
	kPOVAttrib_PixelsToFile   = 'PxTo', ///< file to write the rendered rows to, as they are before encoding
	kPOVAttrib_PixelsFromFile = 'PxFr'  ///< file of such rows that make the picture: nothing is rendered
};

#define REPRODUCIBLE_INI_KEYS \
	{ "Pixels_From_File",    kPOVAttrib_PixelsFromFile,     kPOVMSType_UCS2String }, \
	{ "Pixels_To_File",      kPOVAttrib_PixelsToFile,       kPOVMSType_UCS2String }, \
	{ "Reproducible",        kPOVAttrib_Reproducible,       kPOVMSType_Bool },

#endif
