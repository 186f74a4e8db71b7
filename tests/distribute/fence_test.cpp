// SPDX-License-Identifier: AGPL-3.0-or-later
// The fence with something behind it that can do far more than a scene: a shell. Each deed succeeds without the fence, and fails
// in it.
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/sandbox/sandbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <arpa/inet.h>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <set>
#include <sstream>
#include <sys/socket.h>
#include <sys/stat.h>
#include <thread>
#include <tuple>
#include <unistd.h>

using namespace farm;

namespace {

const char* const shell = "/bin/bash";

/// A shell may do without the C library's tools: redirections and built-in words need no second process.
class Fence : public testing::Test {
protected:
	void SetUp() override {
		try {
			sandbox = Sandbox(shell);
		} catch (const Error& e) {
			// Only where bubblewrap by itself does not work either: a fence of ours that is broken must fail.
			if (std::system("bwrap --unshare-all --ro-bind / / true >/dev/null 2>&1") != 0)
				GTEST_SKIP() << e.what();
			throw;
		}
		for (const char* name : {"read", "write", "other", "home"})
			fs::create_directory(work.path() / name);
		std::ofstream(work.path() / "read/file") << "seen\n";
		std::ofstream(work.path() / "other/secret") << "secret\n";
		fs::create_symlink(work.path() / "other/secret", work.path() / "read/link");
	}

	/// The exit code; `printed` gets what it said.
	int run_shell(const Sandbox& in, const std::string& script, const Limits& limits = {}) {
		Command command;
		command.words = {shell, "-c", script};
		command.environment = {{"W", work.path().string()}, {"HOME", (work.path() / "home").string()}};
		command.folder = work.path() / "write";
		command.log = work.path() / "log";
		fs::remove(command.log);
		const int code = run(in.fenced(command, {{work.path() / "read"}, {work.path() / "write"}, false}, limits));
		printed = read_file(command.log);
		return code;
	}

	ScratchFolder work{fs::temp_directory_path()};
	Sandbox sandbox;
	std::string printed;
};

TEST_F(Fence, WhatItNeedsIsThere) {
	EXPECT_EQ(run_shell(sandbox, "read -r x < $W/read/file && echo got $x; echo made > $W/write/made; echo here > relative"), 0)
		<< printed;
	EXPECT_EQ(printed, "got seen\n");
	EXPECT_EQ(read_file(work.path() / "write/made"), "made\n");
	EXPECT_EQ(read_file(work.path() / "write/relative"), "here\n");
}

TEST_F(Fence, NothingElse) {
	const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
	sockaddr_in here{};
	here.sin_family = AF_INET;
	here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
	socklen_t size = sizeof here;
	ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&here), size), 0);
	ASSERT_EQ(::listen(listener, 8), 0);
	::getsockname(listener, reinterpret_cast<sockaddr*>(&here), &size);
	::setenv("BHFARM_TEST_SECRET", "secret", 1);
	const int held = ::open((work.path() / "other/secret").c_str(), O_RDONLY); // as another thread's would be
	const std::string port = std::to_string(ntohs(here.sin_port)), me = std::to_string(::getpid());
	const std::pair<const char*, std::string> deeds[] = {
		{"read a file of the system", "read -r x < /etc/passwd && echo DONE"},
		{"read another job's file", "read -r x < $W/other/secret && echo DONE"},
		{"follow a link out", "read -r x < $W/read/link && echo DONE"},
		{"list what is beside", "x=$(:) ; for f in $W/*; do [ $f = $W/other ] && echo DONE; done"},
		{"see the processes", "[ -e /proc/self ] && echo DONE"},
		{"signal a process outside", "kill -0 " + me + " && echo DONE"},
		{"read this program's environment", "[ -n \"$BHFARM_TEST_SECRET\" ] && echo DONE"},
		{"write beside what it reads", "echo x > $W/read/x && echo DONE"},
		{"change what it reads", "echo x >> $W/read/file && echo DONE"},
		{"write where it reads nothing", "echo x > $W/other/x && echo DONE"},
		{"write to the temporary folder", "echo x > /tmp/bhfarm-fence-$$ && echo DONE"},
		{"have a child", "(exit 0) && echo DONE"},
		{"run a program", "exec /usr/bin/env echo DONE"},
		{"connect to the loopback", "exec 5<>/dev/tcp/127.0.0.1/" + port + " && echo DONE"},
	};
	for (const auto& [what, script] : deeds) {
		run_shell({}, script);
		EXPECT_NE(printed.find("DONE"), std::string::npos) << "without a fence it should " << what << ": " << printed;
		run_shell(sandbox, script);
		EXPECT_EQ(printed.find("DONE"), std::string::npos) << "in the fence it could " << what << ": " << printed;
	}
	EXPECT_NE(run_shell({}, "read -r x <&" + std::to_string(held)), 0) << "another thread's file";
	::close(held);
	::close(listener);
	for (const auto& left : fs::directory_iterator("/tmp"))
		if (left.path().filename().string().rfind("bhfarm-fence-", 0) == 0)
			fs::remove(left);
}

// Nor does anything tell where it lies here, the program itself included.
TEST_F(Fence, ThingsAreWhereTheyAreOnEachMachine) {
	Command command;
	command.words = {shell, "-c",
		"read -r x < /r/file && echo $x; echo x > y; for f in /* /home/*; do echo $f; done; [ -e $W ] && echo HERE; [ -e " +
			std::string(shell) + " ] && echo SHELL"};
	command.environment = {{"W", work.path().string()}};
	command.folder = "/w/x";
	command.log = work.path() / "log";
	run(sandbox.fenced(
		command, {{sandbox.placed(work.path() / "read", "/r")}, {sandbox.placed(work.path() / "write", "/w/x")}, false}));
	printed = read_file(command.log);
	EXPECT_EQ(printed.substr(0, 5), "seen\n") << printed;
	EXPECT_EQ(read_file(work.path() / "write/y"), "x\n");
	std::istringstream lines(printed.substr(std::min<size_t>(5, printed.size())));
	int hidden = 0; // the libraries, under a name that only who may list a folder can find
	for (std::string line; std::getline(lines, line);)
		if (line.size() == 33)
			++hidden;
		else
			EXPECT_TRUE((std::set<std::string>{"/dev", "/home/*", "/lib64", "/program", "/r", "/w"}).count(line)) << line;
	EXPECT_EQ(hidden, 1);
	EXPECT_EQ(Sandbox().placed("/a", "/b").at, "/a") << "without a fence things are where they are";
}

TEST_F(Fence, TheWholeFileSystemMayBeReadWhereOneAsks) {
	Command command;
	command.words = {shell, "-c",
		"read -r x < /etc/passwd && echo READ; echo x > $W/other/x && echo WROTE; echo x > $W/write/x && echo MADE; [ -e "
		"/proc/self ] || :"};
	command.environment = {{"W", work.path().string()}};
	command.log = work.path() / "log";
	run(sandbox.fenced(command, {{}, {work.path() / "write"}, true}));
	printed = read_file(command.log);
	EXPECT_NE(printed.find("READ"), std::string::npos) << printed;
	EXPECT_NE(printed.find("MADE"), std::string::npos) << printed;
	EXPECT_EQ(printed.find("WROTE"), std::string::npos) << printed;
}

TEST_F(Fence, EachLimitSaysWhichItIs) {
	Limits limits;
	limits.cpu = 1;
	limits.output = 1 << 20;
	limits.memory = 256 << 20;
	Limits patient = limits; // a slow machine may write less than a megabyte in a second
	patient.cpu = 300;
	const std::tuple<const char*, const char*, Sandbox> bombs[] = {
		{"while :; do :; done", "--cpu-limit allows, 1 s", sandbox},
		{"while :; do echo 12345678901234567890; done > big", "--output-limit allows, 1 MB", sandbox},
		{"while :; do echo 12345678901234567890; done", "--output-limit allows, 1 MB", sandbox},
		{"x=0123456789; while :; do x=$x$x; done", "--memory-limit allows, 256 MB", sandbox},
		{"while :; do :; done", "--cpu-limit allows, 1 s", {}},
	};
	for (const auto& [script, line, in] : bombs) {
		const Limits& kept = std::string(line).find("--cpu") == 0 ? limits : patient;
		Overseer overseer(kept, work.path() / "write");
		const int code = run_shell(in, script, kept);
		EXPECT_NE(overseer.complaint(code, printed.substr(0, 1000)).find(line), std::string::npos)
			<< script << ": " << code << " " << printed.substr(0, 300);
		fs::remove(work.path() / "write/big");
	}
	// Many small files are no way around it.
	Overseer overseer(patient, work.path() / "write");
	EXPECT_EQ(run_shell(sandbox, "for ((i = 0; i < 400; ++i)); do : > f$i; done", patient), 0) << printed;
	EXPECT_NE(overseer.complaint().find("--output-limit"), std::string::npos);
	// Those who keep within them hear nothing.
	fs::remove_all(work.path() / "write");
	EXPECT_EQ(Overseer(limits, work.path() / "write").complaint(), "");
	EXPECT_EQ(Overseer(limits, work.path() / "write").complaint(1, "Parse Error"), "");
}

/// Processes with this among their words.
int count_of(const std::string& word) {
	int found = 0;
	for (const auto& entry : fs::directory_iterator("/proc")) {
		std::ifstream in(entry.path() / "cmdline");
		const std::string words{std::istreambuf_iterator<char>(in), {}};
		found += words.find(word) != std::string::npos;
	}
	return found;
}

TEST_F(Fence, NothingOutlivesTheOneThatStartedIt) {
	const std::string mark = "mark-" + work.path().filename().string();
	Command command;
	command.words = {shell, "-c", "echo up > $W/write/up; while :; do read -t 1 x <> $W/write/pipe; done", mark};
	command.environment = {{"W", work.path().string()}};
	command.log = work.path() / "log";
	ASSERT_EQ(::mkfifo((work.path() / "write/pipe").c_str(), 0600), 0);
	const auto within = [](const auto& condition) {
		const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
		while (!condition() && std::chrono::steady_clock::now() < until)
			std::this_thread::sleep_for(std::chrono::milliseconds(20));
		return condition();
	};
	{
		const Process process(sandbox.fenced(command, {{}, {work.path() / "write"}, false}));
		ASSERT_TRUE(within([&] { return fs::exists(work.path() / "write/up"); }));
		EXPECT_GE(count_of(mark), 2); // bubblewrap has the words too
		::kill(process.id(), SIGKILL);
		EXPECT_TRUE(within([&] { return count_of(mark) <= 0; })) << "bubblewrap killed by itself";
	}
	EXPECT_EQ(count_of(mark), 0);
}

TEST(FenceWords, AreInTheirOrder) {
	Command command;
	command.words = {"/bin/p", "--flag"};
	command.folder = "/w/here";
	command.environment = {{"A", "b c"}};
	const Room room{{Seen("/from", "/r")}, {Seen("/r/w")}, false};
	const auto words = fence_words("/usr/bin/bwrap", room, command);
	const auto at = [&](const std::string& word) { return std::find(words.begin(), words.end(), word) - words.begin(); };
	for (const char* needed : {"--unshare-all", "--die-with-parent", "--cap-drop", "--seccomp", "--clearenv"})
		EXPECT_LT(at(needed), at("--")) << needed;
	EXPECT_EQ(at("/r"), at("/from") + 1);
	EXPECT_LT(at("/r"), at("/r/w")) << "what is written to lies within what is read";
	EXPECT_LT(at("/r/w"), at("--remount-ro"));
	EXPECT_LT(at("--clearenv"), at("--setenv"));
	EXPECT_EQ(std::vector<std::string>(words.end() - 3, words.end()), (std::vector<std::string>{"--", "/bin/p", "--flag"}));
	EXPECT_EQ(std::count(words.begin(), words.end(), "/"), 1) << "nothing but the remount names the root";
}

} // namespace
