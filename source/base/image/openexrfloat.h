// SPDX-License-Identifier: AGPL-3.0-or-later
/// OpenEXR files with 32 bits a channel, beside stock's with 16.
#ifndef POVRAY_BASE_OPENEXRFLOAT_H
#define POVRAY_BASE_OPENEXRFLOAT_H

#include <ImfHeader.h>
#include <ImfIO.h>

#include "base/image/image.h"
#include "base/image/encoding.h"

namespace pov_base
{

namespace OpenEXR
{

/// Writes FLOAT channels R, G, B and, with `alpha`, A; the values are those that stock rounds to half.
///   header  as for the half file: size, compression, metadata; without channels
///   gamma   from the image's colours to the file's linear ones
///   premul  whether the file's colours are to be premultiplied
/// Throws what OpenEXR throws when the stream cannot be written.
void Write_Float(Imf::OStream& stream, Imf::Header header, const Image *image, const GammaCurvePtr& gamma, bool premul, bool alpha);

}

}

#endif
