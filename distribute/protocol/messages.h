// SPDX-License-Identifier: AGPL-3.0-or-later
/// What server, worker and client say to each other, as structs and as JSON. docs/PROTOCOL.md tells the same to people.
///
/// Each struct has `to_json` and a `from_json` that throws Error with one line naming the field if anything is missing, of the
/// wrong type or out of range. Unknown fields are ignored, so that newer peers may say more.
#ifndef FARM_MESSAGES_H
#define FARM_MESSAGES_H

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace farm {

using json = nlohmann::json;

/// Goes up when an older peer would do the wrong thing. Part of each path: /v1/...
constexpr int protocol_version = 1;

/// Bounds on what is taken from others.
namespace limits {
constexpr std::int64_t pixels = 1 << 16;         ///< width or height
constexpr std::int64_t area = 1 << 30;           ///< of a frame: povray keeps 20 bytes a pixel, for whatever strip of it
constexpr std::int64_t frames = 1000000;         ///< of a job
constexpr std::int64_t strips = 2000000;         ///< of a job
constexpr std::int64_t files = 20000;            ///< of a bundle
constexpr std::int64_t file_bytes = 2LL << 30;   ///< one file of a bundle
constexpr std::int64_t bundle_bytes = 8LL << 30; ///< all of it
constexpr std::int64_t message_bytes = 8 << 20;  ///< a JSON body
constexpr std::int64_t strip_bytes = 512 << 20;  ///< a strip's picture
constexpr std::int64_t log_bytes = 64 << 10;     ///< what is kept of a failed render's output
} // namespace limits

/// One file of a bundle.
struct BundleFile {
	std::string name; ///< as the scene asks for it, relative, below the bundle's root; no "..", no empty part
	std::string sha256;
	std::int64_t bytes = 0;
};

/// All that a scene reads. Its own name is the SHA-256 of its canonical JSON, so equal bundles are one.
struct Bundle {
	std::string folder; ///< where povray runs, below the bundle's root; empty for the root itself
	std::vector<BundleFile> files;
	std::string id() const;
};

enum class Format { png, exr };

/// What is to be rendered, settled at submit.
struct JobSpec {
	std::string name; ///< of the pictures, without frame number and suffix; no slash
	std::string bundle;
	std::vector<std::string> options;  ///< POV-Ray's INI lines, "Key=value", in order; nothing that the farm itself sets
	int width = 0, height = 0;         ///< pixels
	bool animation = false;            ///< whether the pictures are numbered
	int first = 0, last = 0, step = 1; ///< frames; one frame 0 if not an animation
	int digits = 0;                    ///< of the frame number in the pictures' names
	Format format = Format::png;
	int bits = 8;              ///< a channel
	int strip_rows = 0;        ///< rows of a strip, the last of a frame apart; multiples of 32 cost least
	std::string whole_because; ///< why frames are not cut; empty if they may be
	int priority = 0;          ///< higher first, from -100 to 100
	double film_rate = 0;      ///< frames a second of the film; 0: none
	std::string client_key;    ///< the submitter's own name for it: a second submit with the same key is the same job

	int frames() const { return (last - first) / step + 1; }
	int frame(int index) const { return first + index * step; }
	int strips_per_frame() const { return (height + strip_rows - 1) / strip_rows; }
	int strips() const { return frames() * strips_per_frame(); }
	/// Of a job's strip, counted frame by frame: its frame, its first row, and how many it has.
	int frame_of(int strip) const { return frame(strip / strips_per_frame()); }
	int row_of(int strip) const { return strip % strips_per_frame() * strip_rows; }
	int rows_of(int strip) const { return std::min(strip_rows, height - row_of(strip)); }
	/// The picture's file name, as POV-Ray makes it.
	std::string picture(int frame) const;
	std::string suffix() const { return format == Format::png ? ".png" : ".exr"; }
	/// Throws Error if anything is out of range.
	void check() const;
	/// Likewise the frame's size alone.
	void check_size() const;
};

/// A worker presents itself. Said again whenever the server does not know it, with the same id.
struct Hello {
	std::string id;   ///< chosen by the worker, 32 hexadecimal digits
	std::string name; ///< for people
	int slots = 1;
	std::string povray; ///< the first line of `povray --version`
	std::string probe;  ///< SHA-256 of the calibration strip's pixels
};

/// A strip lent to a worker.
struct Task {
	std::int64_t lease = 0;
	std::int64_t job = 0;
	int frame = 0; ///< POV-Ray's frame number
	int row = 0;   ///< first row of the strip, from 0
	int rows = 0;
	JobSpec spec;
};

/// A render that did not work.
struct Failure {
	std::string line;     ///< POV-Ray's own words, one line
	std::string log;      ///< the end of its output
	bool limited = false; ///< by a limit of the worker's own, which it is not to be blamed for
};

void to_json(json& j, const BundleFile& v);
void from_json(const json& j, BundleFile& v);
void to_json(json& j, const Bundle& v);
void from_json(const json& j, Bundle& v);
void to_json(json& j, const JobSpec& v);
void from_json(const json& j, JobSpec& v);
void to_json(json& j, const Hello& v);
void from_json(const json& j, Hello& v);
void to_json(json& j, const Task& v);
void from_json(const json& j, Task& v);
void to_json(json& j, const Failure& v);
void from_json(const json& j, Failure& v);

/// Parses text to a JSON object; throws Error with one line. Depth and size are bounded.
json parse_object(const std::string& text);

} // namespace farm
#endif
