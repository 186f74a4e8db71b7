// SPDX-License-Identifier: AGPL-3.0-or-later
#include "povray.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace {

// Removed at exit, so that a failing test's files can be looked at while it runs under a debugger.
struct Folders {
	std::vector<std::string> list;
	~Folders() {
		std::error_code ignored;
		for (const std::string& f : list)
			std::filesystem::remove_all(f, ignored);
	}
} folders;

} // namespace

Picture read_ppm(const std::string& file) {
	Picture p;
	std::ifstream in(file, std::ios::binary);
	std::string magic;
	int most = 0;
	// POV-Ray writes comments behind the magic number.
	in >> magic >> std::ws;
	while (in.peek() == '#') {
		std::string comment;
		std::getline(in, comment);
		in >> std::ws;
	}
	if (!(in >> p.width >> p.height >> most) || magic != "P6" || most != 65535)
		return Picture();
	in.get();
	const std::string data((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
	const std::size_t n = std::size_t(p.width) * std::size_t(p.height) * 3;
	if (data.size() != 2 * n)
		return Picture();
	p.samples.resize(n);
	for (std::size_t i = 0; i < n; i++)
		p.samples[i] = std::uint16_t((std::uint8_t(data[2 * i]) << 8) | std::uint8_t(data[2 * i + 1]));
	return p;
}

std::string joined(const std::string& text) {
	std::string out;
	for (char c : text)
		if (c != '\n' && !(c == ' ' && !out.empty() && out.back() == ' '))
			out += c;
	return out;
}

std::string number(double value) {
	char text[40];
	std::snprintf(text, sizeof text, "%.17g", value);
	return text;
}

Rendering povray(const std::string& scene, int width, int height, const std::string& words) {
	Rendering run;
	char name[] = "/tmp/blackhole-test-XXXXXX";
	if (!mkdtemp(name))
		std::abort();
	run.folder = name;
	folders.list.push_back(name);
	std::ofstream(run.folder + "/scene.pov") << "#version 3.7; global_settings { assumed_gamma 1 }\n" << scene << "\n";
	std::ostringstream command;
	// HOME: the user's own povray.ini has no say in a test.
	command << "cd " << name << " && HOME=" << name << " timeout 600 " << POVRAY
			<< " +Iscene.pov +Oscene.ppm +FP16 File_Gamma=1 -D -A +WT1 +L" << INCLUDES << " +L" << OUR_INCLUDES << " +W" << width
			<< " +H" << height << " " << words << " >out 2>&1";
	for (int tries = 0; tries < 20; tries++) {
		const int status = std::system(command.str().c_str());
		run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
		std::ifstream out(run.folder + "/out");
		run.text.assign(std::istreambuf_iterator<char>(out), std::istreambuf_iterator<char>());
		// On a busy machine it may give up before it begins.
		if (run.text.find("Timed out waiting for worker thread startup") == std::string::npos)
			break;
	}
	// Less the banner, where there is more than that. (Not from "==== [Parsing...]" on: when parsing is quick,
	// POV-Ray's console prints the first messages above that line.)
	const std::size_t last_option = run.text.find("Warning Stream to console");
	if (last_option != std::string::npos)
		run.text.erase(0, run.text.find('\n', last_option) + 1);
	run.picture = read_ppm(run.folder + "/scene.ppm");
	return run;
}
