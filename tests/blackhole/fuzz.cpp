// SPDX-License-Identifier: AGPL-3.0-or-later
/// Coverage-guided fuzzing of the library's public interface (clang's libFuzzer): whatever doubles the bytes are, a ray that the
/// headers allow must keep what extremes.h checks; any other must not crash.
#include "extremes.h"

#include "blackhole/frames.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace blackhole;

namespace {

// Numbers that lie in the way of rounding, which bytes alone seldom hit.
const double marks[] = {0, 1, 1.5, 3, critical_b, 1e-8, 1e-16, 1e-310, 1e300, 1e12, 0.1, -1, 6.75, 1.5000001, 1 - 1e-8, 2.0 / 3};

class Bytes {
public:
	Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
	std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
	double number() {
		const std::uint8_t how = byte();
		if (how < 64) { // a mark, some last digits beside
			double v = marks[how % 16];
			for (int n = how / 16; n > 0; n--)
				v = std::nextafter(v, n & 1 ? 1e308 : -1e308);
			return v;
		}
		std::uint64_t bits = 0;
		for (int i = 0; i < 8; i++)
			bits = bits << 8 | byte();
		if (how < 128) { // any double
			double v;
			std::memcpy(&v, &bits, sizeof v);
			return v;
		}
		const double share = double(bits >> 11) * 0x1p-53; // an ordinary one
		return how < 192 ? 2 * share - 1 : std::pow(10, 18 * share - 6);
	}

private:
	const std::uint8_t* data_;
	std::size_t size_, at_ = 0;
};

bool finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

[[noreturn]] void fail(const extremes::Ray& ray, const std::string& what) {
	std::fprintf(stderr, "fuzz: %s: %s\n", what.c_str(), ray.text().c_str());
	std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
	Bytes bytes(data, size);
	const std::uint8_t how = bytes.byte();
	extremes::Ray ray;
	if (how & 1) { // by radius and angle, as rays mostly come
		const double r = bytes.number(), b = bytes.number();
		const double s = std::fabs(b) < 1 ? b : b / r / std::sqrt(1 + b * b / (r * r * r));
		ray.x = {r, 0, 0};
		ray.d = {(how & 2 ? 1 : -1) * std::sqrt(1 - s * s), s, 0};
	} else {
		ray.x = {bytes.number(), bytes.number(), bytes.number()};
		ray.d = {bytes.number(), bytes.number(), bytes.number()};
	}
	const double R = bytes.number(), r = length(ray.x);
	// Narrow tolerances take a thousand times as long and other numbers, no other lines.
	const double tolerance = std::pow(10, -1 - (how & 4 ? 3.0 : 1.0) * bytes.byte() / 255.0);
	ray.settings = {R > 1.5 && R >= r ? R : std::max(r, 1.5000001), tolerance, Method((how >> 5) % 3)};
	ray.ramp = how & 8;
	if (!extremes::allowed(ray) || r > 1e12)
		return 0;

	static Path path;
	extremes::Figures figures;
	const std::string what = extremes::check(ray, (how & 16) != 0, path, figures);
	if (!what.empty())
		fail(ray, what);

	// The same by charts, of one of a few holes: they take a while to make.
	static const Atlas atlases[] = {Atlas({1000, 1e-3, Method::rk4}), Atlas({10, 1e-4, Method::dopri5}),
		Atlas({1.6, 1e-2, Method::rk4}), Atlas({1e12, 5e-4, Method::rk4})};
	const Atlas& atlas = atlases[bytes.byte() % 4];
	extremes::Ray charted = ray;
	charted.settings = atlas.settings();
	if (const double R = charted.settings.effect_radius; r > R)
		charted.x = (R / r) * charted.x;
	extremes::Charted_Figures charted_figures;
	if (const std::string wrong = extremes::allowed(charted) ? extremes::check(charted, atlas, charted_figures) : "";
		!wrong.empty())
		fail(charted, "charted: " + wrong);

	// frames.h, for unit directions outside the horizon: there and back.
	Vec3 falling;
	const Vec3 unit_d = unit(ray.d);
	const double effect = ray.settings.effect_radius;
	if (r > 1.000001) {
		const Vec3 c = static_to_coordinate(ray.x, unit_d, effect), s = coordinate_to_static(ray.x, c, effect);
		// g at its least is 1e-3, so the last digits of the radial part are worth a thousand.
		if (!finite(c) || !(length(s - unit_d) < 1e-12))
			fail(ray, "static frame and back");
		if (!falling_to_coordinate(ray.x, unit_d, effect, falling) || !finite(falling) ||
			!(std::fabs(length(falling) - 1) < 1e-14))
			fail(ray, "falling frame");
	}
	return 0;
}
