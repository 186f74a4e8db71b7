// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/common/files.h"

#include "distribute/common/error.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fcntl.h>
#include <mutex>
#include <pwd.h>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace farm {
namespace {

/// 0, or errno of what went wrong. `last` is called with the descriptor before it is closed.
template <class Last> int write_and(Last last, const fs::path& file, std::string_view data) {
	const int d = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
	if (d < 0)
		return errno;
	ssize_t n = 0;
	while (!data.empty() && (n = ::write(d, data.data(), data.size())) >= 0)
		data.remove_prefix(static_cast<size_t>(n));
	int error = n < 0 || last(d) != 0 ? errno : 0;
	if (::close(d) != 0 && !error)
		error = errno;
	return error;
}

fs::path user_folder(const char* variable, const char* otherwise) {
	const char* xdg = std::getenv(variable);
	if (xdg && *xdg == '/')
		return fs::path(xdg) / "bhfarm";
	const char* home = std::getenv("HOME");
	if (!home || *home != '/') {
		const passwd* self = ::getpwuid(::geteuid());
		home = self ? self->pw_dir : nullptr;
	}
	// Not below /tmp: what others could put there first would be taken for ours.
	if (!home || *home != '/')
		throw Error(std::string("there is no place to keep things: set HOME or ") + variable);
	return fs::path(home) / otherwise / "bhfarm";
}

} // namespace

void sync_folder(const fs::path& folder) {
	const int d = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
	if (d < 0)
		throw system_error("cannot open " + folder.string());
	const int failed = ::fsync(d);
	::close(d);
	if (failed)
		throw system_error("cannot sync " + folder.string());
}

int write_file(const fs::path& file, std::string_view data) {
	return write_and([](int) { return 0; }, file, data);
}

void write_scratch(const fs::path& file, std::string_view data) {
	if (const int error = write_file(file, data)) {
		errno = error;
		throw system_error("cannot write " + file.string());
	}
}

void write_durably(const fs::path& file, std::string_view data) {
	const fs::path part = file.string() + ".part" + std::to_string(::getpid());
	if (const int error = write_and(::fsync, part, data); error || ::rename(part.c_str(), file.c_str()) != 0) {
		errno = error ? error : errno;
		const Error why = system_error("cannot write " + file.string());
		::unlink(part.c_str());
		throw why;
	}
	sync_folder(file.parent_path());
}

void move_durably(const fs::path& from, const fs::path& to) {
	const int d = ::open(from.c_str(), O_RDONLY | O_CLOEXEC);
	const bool synced = d >= 0 && ::fsync(d) == 0;
	if (d >= 0)
		::close(d);
	if (!synced || ::rename(from.c_str(), to.c_str()) != 0)
		throw system_error("cannot write " + to.string());
	sync_folder(to.parent_path());
}

void write_out(std::string_view data, const std::string& what) {
	if (std::fwrite(data.data(), 1, data.size(), stdout) != data.size() || std::fflush(stdout) != 0)
		throw system_error("cannot write " + what);
}

void make_folder(const fs::path& folder) {
	std::error_code error;
	fs::create_directories(folder, error);
	if (error)
		throw Error("cannot make the folder " + folder.string() + ": " + error.message(), error.value());
}

std::string read_file(const fs::path& file) {
	const int d = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
	if (d < 0)
		throw system_error("cannot read " + file.string());
	// A little more than it seems to have, to see its end; what has no size (/proc) grows as it comes.
	std::error_code unknown;
	const auto size = fs::file_size(file, unknown);
	std::string all(unknown ? 1 << 16 : static_cast<size_t>(size) + 1, 0);
	size_t have = 0;
	ssize_t n = 0;
	while ((n = ::read(d, all.data() + have, all.size() - have)) > 0) {
		have += static_cast<size_t>(n);
		if (have == all.size())
			all.resize(2 * have);
	}
	const Error error = system_error("cannot read " + file.string());
	::close(d);
	if (n < 0)
		throw error;
	all.resize(have);
	return all;
}

namespace {

/// Scratch folders whose process was killed; once for each parent. An hour old, as one just made is not locked yet.
void remove_forsaken(const fs::path& parent) {
	static std::mutex one_at_a_time;
	static std::set<fs::path> seen;
	const std::lock_guard guard(one_at_a_time);
	if (!seen.insert(parent).second)
		return;
	std::error_code error;
	for (fs::directory_iterator at(parent, error), end; !error && at != end; at.increment(error)) {
		const std::string name = at->path().filename().string();
		if (name.rfind("bhfarm-", 0) != 0 || name.size() != 13)
			continue;
		const int d = ::open(at->path().c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
		struct stat s {};
		std::error_code ignored;
		if (d >= 0 && ::fstat(d, &s) == 0 && s.st_uid == ::geteuid() && ::time(nullptr) - s.st_mtime >= 3600 &&
			::flock(d, LOCK_EX | LOCK_NB) == 0)
			fs::remove_all(at->path(), ignored);
		if (d >= 0)
			::close(d);
	}
}

} // namespace

std::string read_secret(const fs::path& file) {
	std::string text = read_file(file);
	std::error_code ignored;
	if ((fs::status(file, ignored).permissions() & fs::perms::others_read) != fs::perms::none &&
		fs::is_regular_file(file, ignored))
		say("everybody here can read " + file.string() + "; 'chmod 600' keeps it secret");
	return text;
}

ScratchFolder::ScratchFolder(const fs::path& parent) {
	std::error_code ignored;
	fs::create_directories(parent, ignored);
	remove_forsaken(parent);
	const std::string pattern = (parent / "bhfarm-XXXXXX").string();
	std::vector<char> name(pattern.begin(), pattern.end());
	name.push_back(0);
	if (!::mkdtemp(name.data()))
		throw system_error("cannot make a folder in " + parent.string());
	folder = name.data();
	lock = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
	if (lock >= 0)
		::flock(lock, LOCK_EX | LOCK_NB);
}

ScratchFolder::~ScratchFolder() {
	std::error_code ignored;
	fs::remove_all(folder, ignored);
	if (lock >= 0)
		::close(lock);
}

FileLock::FileLock(const fs::path& file, const std::string& taken)
	: descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
	if (descriptor < 0)
		throw system_error("cannot write " + file.string());
	if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
		::close(descriptor);
		throw Error(taken);
	}
}

FileLock::~FileLock() { ::close(descriptor); }

fs::path program_folder() {
	std::error_code error;
	const fs::path self = fs::read_symlink("/proc/self/exe", error);
	return error ? fs::path(".") : self.parent_path();
}

fs::path state_folder() { return user_folder("XDG_STATE_HOME", ".local/state"); }
fs::path cache_folder() { return user_folder("XDG_CACHE_HOME", ".cache"); }

} // namespace farm
