// SPDX-License-Identifier: AGPL-3.0-or-later
/// How povray is run: the INI file it is given, the command, and what its output says.
#ifndef FARM_POVRAY_H
#define FARM_POVRAY_H

#include "distribute/common/arguments.h"
#include "distribute/common/process.h"
#include "distribute/protocol/messages.h"
#include "distribute/sandbox/sandbox.h"

#include <filesystem>

namespace farm {

/// The INI lines that say which frame of a job is rendered: its own options, then ours. Rows and output are not among them.
std::string povray_ini(const JobSpec& spec, int frame);
/// Likewise for rows [row, row + rows), written as a PNG or EXR of the whole frame's size to `picture` (a path without spaces).
std::string strip_ini(const Task& task, const std::filesystem::path& picture);

/// The line by which povray finds what it asks for in a scene's folder while it runs elsewhere.
std::string scene_in(const std::filesystem::path& folder);

/// povray with that INI file and no other, a home of its own, and no display. Its
/// temporary files go to `home` too.
Command povray_command(const std::filesystem::path& povray, const std::filesystem::path& ini, const std::filesystem::path& home);

/// POV-Ray's error message as one line, from what it printed; the exit code's meaning where it said nothing. Files below
/// `folder` are named as they are in there.
std::string error_line(const std::string& log, int code, const std::filesystem::path& folder = {});

/// Whether povray gave up before it began, because its threads took longer to start than it waits on a busy machine: to be tried
/// again.
bool did_not_start(const std::string& log);

/// Runs such a command to its end, again where it did not start; its exit code and what it printed to its log. Throws Stopped
/// once `stop` is true.
std::pair<int, std::string> run_povray(const Command& command, const std::atomic<bool>* stop = nullptr);

inline const Option povray_option{"--povray", "FILE", "the povray to run; default the one beside this program", ""};
/// The program beside ours, or what --povray says; throws Error if there is none.
std::filesystem::path find_povray(const std::string& given);
/// "POV-Ray 3.7.0.10.unofficial", the first line of `povray --version`; throws Error if it does not run.
std::string povray_version(const std::filesystem::path& povray, const Sandbox& sandbox);

} // namespace farm
#endif
