// SPDX-License-Identifier: AGPL-3.0-or-later
// What hangs, and what only looks like it.
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/sandbox/pulse.h"
#include "distribute/sandbox/sandbox.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <sys/stat.h>
#include <thread>

using namespace farm;

namespace {

const char* const shell = "/bin/bash";
const char* const sleeps = "echo >up; while :; do read x <>pipe; done";
const char* const works = "echo >up; while :; do :; done";
const char* const looks_around = "echo >up; while :; do read -t 0.001 x <>pipe; done";

class PulseOf : public testing::Test {
protected:
	ScratchFolder work{fs::temp_directory_path()};

	void SetUp() override { ASSERT_EQ(::mkfifo((work.path() / "pipe").c_str(), 0600), 0); }
	/// A shell that does this, once it is at it.
	Process start(const std::string& script, const Sandbox& sandbox = {}) {
		Command command;
		command.words = {shell, "-c", script};
		command.folder = work.path();
		fs::remove(work.path() / "up");
		Process process(sandbox.fenced(command, {{}, {work.path()}, false}));
		while (!fs::exists(work.path() / "up") && !process.over(0.01)) {
		}
		EXPECT_FALSE(process.over(0));
		return process;
	}
	/// How often one looks at what must be found: on a busy machine what sleeps waits for a processor at most looks.
	static constexpr int patiently = 1000000;
	/// Whether it is found to hang, looked at so often; the clock says that a second has passed from one to the next.
	static bool found(const Process& process, int looks, double limit, double second = 1) {
		Pulse pulse(process.id(), limit);
		for (int i = 0; i < looks; ++i) {
			if (pulse.hangs(i * second))
				return true;
			std::this_thread::sleep_for(std::chrono::milliseconds(5));
		}
		return false;
	}
};

TEST_F(PulseOf, WhatSleepsHangs) {
	const Process process = start(sleeps);
	EXPECT_TRUE(found(process, patiently, 100));
	EXPECT_FALSE(found(process, 90, 100)) << "in 90 seconds nothing can have slept for 100";
}

TEST_F(PulseOf, WhatWakesUpToLookAroundHangsToo) {
	const Process process = start(looks_around);
	EXPECT_TRUE(found(process, patiently, 300));
}

TEST_F(PulseOf, WhatWorksDoesNot) {
	const Process process = start(works);
	EXPECT_FALSE(found(process, 300, 100));
}

TEST_F(PulseOf, WhatSomebodyHasStoppedDoesNot) {
	const Process process = start(sleeps);
	process.signal(SIGSTOP);
	const auto state = [&] {
		std::ifstream in("/proc/" + std::to_string(process.id()) + "/stat");
		const std::string text{std::istreambuf_iterator<char>(in), {}};
		return text.at(text.rfind(')') + 2);
	};
	while (state() != 'T')
		std::this_thread::sleep_for(std::chrono::milliseconds(1));
	EXPECT_FALSE(found(process, 300, 100));
	process.signal(SIGCONT);
	EXPECT_TRUE(found(process, patiently, 100));
}

TEST_F(PulseOf, WhatIsNotThereDoesNot) {
	Process process = start("echo >up; exit 0 <pipe");
	Pulse pulse(process.id(), 1);
	process.signal(SIGKILL);
	process.over(-1);
	for (int i = 0; i < 10; ++i)
		EXPECT_FALSE(pulse.hangs(i));
}

TEST_F(PulseOf, TimeThatNobodySawDoesNotCount) {
	const Process process = start(sleeps);
	EXPECT_FALSE(found(process, 50, 100, 3600)) << "the machine slept for an hour between any two looks";
}

TEST_F(PulseOf, BehindTheFenceItIsSeenToo) {
	Sandbox sandbox;
	try {
		sandbox = Sandbox(shell);
	} catch (const Error& e) {
		if (std::system("bwrap --unshare-all --ro-bind / / true >/dev/null 2>&1") != 0)
			GTEST_SKIP() << e.what();
		throw;
	}
	{
		const Process process = start(works, sandbox);
		EXPECT_FALSE(found(process, 300, 100)) << "bubblewrap itself only waits";
	}
	const Process process = start(sleeps, sandbox);
	EXPECT_TRUE(found(process, patiently, 100));
}

} // namespace
