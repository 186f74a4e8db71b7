// SPDX-License-Identifier: AGPL-3.0-or-later
#include "base/configbase.h"
#include "base/image/openexrfloat.h"

#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>

// this must be the last file included
#include "base/povdebug.h"

namespace pov_base
{

namespace OpenEXR
{

void Write_Float(Imf::OStream& stream, Imf::Header header, const Image *image, const GammaCurvePtr& gamma, bool premul, bool alpha)
{
	static const char *const names[] = { "R", "G", "B", "A" };
	const int width = image->GetWidth(), height = image->GetHeight();
	const size_t column = 4 * sizeof(float);

	// One row is kept at a time: OpenEXR copies it, and finds the next at the same place as the row stride is none.
	std::vector<float> row(size_t(width) * 4);
	Imf::FrameBuffer rows;
	for(int c = 0; c < (alpha ? 4 : 3); c++)
	{
		header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
		rows.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(&row[c]), column, 0));
	}

	Imf::OutputFile file(stream, header);
	file.setFrameBuffer(rows);
	for(int y = 0; y < height; y++)
	{
		for(int x = 0; x < width; x++)
		{
			float *p = &row[size_t(x) * 4];
			GetEncodedRGBAValue(image, x, y, gamma, p[0], p[1], p[2], p[3], premul);
		}
		file.writePixels(1);
	}
}

}

}
