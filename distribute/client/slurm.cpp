// SPDX-License-Identifier: AGPL-3.0-or-later
// bhfarm slurm: workers where Slurm has room for them.
#include "distribute/client/commands.h"
#include "distribute/common/error.h"
#include "distribute/common/files.h"
#include "distribute/common/process.h"
#include "distribute/http/client.h"
#include "distribute/sandbox/limits.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace farm {
namespace {

const std::vector<Option> slurm_options = {
	{"--workers", "N", "how many; each is a task of the array, and starts when there is room", ""},
	{"--slots", "N", "strips at a time, and cores, of each", "1"},
	{"--partition", "P", "Slurm's; default its own", ""},
	{"--time", "T", "Slurm's time limit, such as 2:00:00; default the partition's", ""},
	{"--grace", "SECONDS", "what a strip may still take when Slurm wants the core back", "20"},
	{"--idle-exit", "SECONDS", "workers leave after so long without work; 0: stay to the time limit", "120"},
	{"--cache", "DIR", "where workers keep scenes; default $XDG_CACHE_HOME/bhfarm", ""},
	{"--dry-run", "", "prints the script and submits nothing", ""},
};

/// Slurm's TERM may come up to a minute too early, never too late; what is done in grace is then sent.
constexpr long to_send = 20;

std::string quoted(const std::string& word) {
	std::string text = "'";
	for (const char c : word)
		text += c == '\'' ? "'\\''" : std::string(1, c);
	return text + "'";
}

/// What a program of Slurm's printed, both streams, and its exit code.
std::pair<int, std::string> ask_slurm(std::vector<std::string> words) {
	const ScratchFolder scratch(fs::temp_directory_path());
	Command command;
	command.words = std::move(words);
	command.log = scratch.path() / "said";
	const int code = run(command);
	return {code, fs::exists(command.log) ? read_file(command.log) : ""};
}

/// Loopback is somebody else on each host.
void check_reachable(const std::string& url, const std::string& partition) {
	// A server that listens everywhere says 0.0.0.0, which leads nowhere else.
	const std::string place = url.substr(url.find("://") + 3);
	if (!on_loopback(place) && place.rfind("0.0.0.0", 0) != 0 && place.rfind("[::]", 0) != 0)
		return;
	std::vector<std::string> words = {"sinfo", "-h", "-N", "-o", "%n"};
	if (!partition.empty())
		words.insert(words.end(), {"-p", partition});
	const auto [code, said] = ask_slurm(words);
	if (code != 0)
		throw Error(
			"the server is at " + url + ", which is this machine alone; name one that Slurm's nodes can reach by --server");
	const auto without_domain = [](const std::string& name) { return name.substr(0, name.find('.')); };
	std::istringstream nodes(said);
	for (std::string node; nodes >> node;)
		if (without_domain(node) != without_domain(host_name()))
			throw Error("Slurm's node " + node + " cannot reach the server at " + url +
						", which is this machine alone; start it with --listen ADDRESS:PORT, and say --server");
}

void check_word(const std::string& what, const std::string& word) {
	const auto odd = [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '"' || c == '\'' || c == '\\'; };
	if (std::any_of(word.begin(), word.end(), odd))
		throw Error(what + " is '" + word + "'; it must be one word");
}

std::string script_for(const Arguments& a, const Access_to& access, const std::string& token_file) {
	const long workers = a.number("--workers", 1, 100000), slots = a.number("--slots", 1, 1024),
			   grace = a.number("--grace", 1, 86400);
	limits_from(a, static_cast<int>(slots)); // refuses what the worker would
	std::string script = "#!/bin/bash\n"
						 "#SBATCH --job-name=bhfarm\n"
						 "#SBATCH --output=bhfarm-%A_%a.log\n"
						 "#SBATCH --open-mode=append\n"
						 "#SBATCH --requeue\n"
						 "#SBATCH --ntasks=1\n";
	script += "#SBATCH --array=1-" + std::to_string(workers) + "\n";
	script += "#SBATCH --cpus-per-task=" + std::to_string(slots) + "\n";
	script += "#SBATCH --signal=B:TERM@" + std::to_string(grace + to_send) + "\n";
	for (const char* name : {"--partition", "--time"})
		if (const std::string& value = a.get(name); !value.empty()) {
			check_word(name, value);
			script += std::string("#SBATCH ") + name + "=" + value + "\n";
		}
	// No shell stays in between: Slurm's TERM is the worker's.
	script += "exec " + quoted((program_folder() / "bhfarm-worker").string()) + " --server " + quoted(access.url);
	if (!token_file.empty())
		script += " --token-file " + quoted(fs::absolute(token_file).string());
	if (!access.authority.empty())
		script += " --ca " + quoted(fs::absolute(access.authority).string());
	if (const std::string& cache = a.get("--cache"); !cache.empty())
		script += " --cache " + quoted(cache);
	for (const auto& limit : limit_options)
		if (a.has(limit.name))
			script.append(" ")
				.append(limit.name)
				.append(limit.value.empty() ? "" : "=")
				.append(limit.value.empty() ? "" : quoted(a.get(limit.name)));
	script += " --slots " + std::to_string(slots) + " --grace " + std::to_string(grace) + " --idle-exit " +
			  std::to_string(a.number("--idle-exit", 0, 1000000));
	return script + " --name \"${SLURMD_NODENAME:-node}-${SLURM_ARRAY_TASK_ID:-0}\"\n";
}

/// Slurm's own words for what it did not like, as one line.
std::string complaint(const std::string& said) {
	std::istringstream lines(said);
	std::string first;
	for (std::string line; std::getline(lines, line);)
		if (const size_t at = line.find("error: "); at != std::string::npos && first.empty())
			first = line.substr(at + 7);
	return first.empty() ? said.substr(0, said.find('\n')) : first;
}

} // namespace

int slurm_command(const Words& words) {
	const auto options = slurm_options + limit_options + access_options;
	const auto end = std::find(words.begin(), words.end(), "--");
	const Arguments a({words.begin(), end}, options);
	help_if_asked(a,
		"bhfarm slurm --workers N [options] [-- sbatch's own options]\n"
		"Submits workers as an array job and prints its number. Run it where Slurm's commands are. bhfarm-worker, the token and\n"
		"the authority must be at the same places on the nodes.",
		options);
	if (!a.rest.empty())
		throw Error("what is '" + a.rest[0] + "'? sbatch's own options stand after --");
	const Access_to access = access_from(a);
	const std::string script = script_for(a, access, or_environment(a.get("--token-file"), "BHFARM_TOKEN_FILE"));
	check_reachable(access.url, a.get("--partition"));
	if (a.has("--dry-run")) {
		std::fputs(script.c_str(), stdout);
		return 0;
	}
	Client(access).get("/v1/workers"); // whether the token is good
	const ScratchFolder scratch(fs::temp_directory_path());
	write_scratch(scratch.path() / "workers.sh", script);
	std::vector<std::string> sbatch = {"sbatch", "--parsable"};
	sbatch.insert(sbatch.end(), end == words.end() ? end : end + 1, words.end());
	sbatch.push_back((scratch.path() / "workers.sh").string());
	const auto [code, said] = ask_slurm(sbatch);
	if (code == 127)
		throw Error("there is no sbatch here; run this where Slurm's commands are, or use --dry-run's script there");
	if (code != 0)
		throw Error("sbatch says: " + complaint(said));
	const std::string last = said.substr(said.find_last_of('\n', said.size() - 2) + 1);
	std::fputs(last.substr(0, last.find_first_of(";\n")).append("\n").c_str(), stdout);
	return 0;
}

} // namespace farm
