// SPDX-License-Identifier: AGPL-3.0-or-later
/// A picture's rows as they are before anything is encoded, rounded or dithered: made in pieces, written as one.
#ifndef POVRAY_FRONTEND_PIXELFILE_H
#define POVRAY_FRONTEND_PIXELFILE_H

#include "base/image/image.h"
#include "base/povmscpp.h"

namespace pov_frontend
{

/// Called before a picture is written.
///   Pixels_To_File    writes the rows Start_Row to End_Row there
///   Pixels_From_File  takes all rows from there, and the gamma they were rendered with
/// Such a file is one record or several, in any order: several files are joined by `cat`. A record is the line
///   pixels 1 WIDTH HEIGHT FIRST LAST WORKING_GAMMA_TYPE WORKING_GAMMA FILE_GAMMA_TYPE FILE_GAMMA
/// (rows from 0; types are POV-Ray's own numbers), then five native floats a pixel: red, green, blue, filter, transmit.
/// Throws a pov_base::Exception that names the file and what is wrong with it.
void Move_Pixels(POVMS_Object& options, pov_base::Image& image);

}

#endif
