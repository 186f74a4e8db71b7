// SPDX-License-Identifier: AGPL-3.0-or-later
/// Files that are there whole or not at all.
#ifndef FARM_FILES_H
#define FARM_FILES_H

#include <filesystem>
#include <string>
#include <string_view>

namespace farm {

namespace fs = std::filesystem;

/// Writes beside the file, fsyncs, renames, and fsyncs the folder: after it returns the file survives a power cut. Throws Error,
/// and leaves nothing behind, if any of that fails.
void write_durably(const fs::path& file, std::string_view data);
/// Writes it without more ado; 0, or errno.
int write_file(const fs::path& file, std::string_view data);
/// Likewise of what is only read by the next program and then removed; throws Error.
void write_scratch(const fs::path& file, std::string_view data);
/// So that what was put into it, or renamed there, survives a power cut. Throws Error.
void sync_folder(const fs::path& folder);
/// Moves a file that is already written to its place, as durably.
void move_durably(const fs::path& from, const fs::path& to);
/// All of it to stdout; throws Error, naming it as `what`.
void write_out(std::string_view data, const std::string& what);
/// A folder, and those above it, unless they are there; throws Error.
void make_folder(const fs::path& folder);
/// The whole content; throws Error.
std::string read_file(const fs::path& file);

/// Likewise, of a file that is nobody else's business; says so if others can read it.
std::string read_secret(const fs::path& file);

/// A folder of its own below `parent` (made if need be), removed with all it holds at the end of its life. If its process is
/// killed, the next one removes it that makes such a folder there an hour later or more.
class ScratchFolder {
public:
	explicit ScratchFolder(const fs::path& parent);
	~ScratchFolder();
	ScratchFolder(const ScratchFolder&) = delete;
	ScratchFolder& operator=(const ScratchFolder&) = delete;
	const fs::path& path() const { return folder; }

private:
	fs::path folder;
	int lock;
};

/// An exclusive lock on a file, for as long as this lives (flock, so the kernel gives it up when the process dies).
class FileLock {
public:
	/// Throws Error with `taken` as its text if another process has it.
	FileLock(const fs::path& file, const std::string& taken);
	~FileLock();
	FileLock(const FileLock&) = delete;
	FileLock& operator=(const FileLock&) = delete;

private:
	int descriptor;
};

/// The folder this program's file is in.
fs::path program_folder();
/// $XDG_STATE_HOME/bhfarm or .local/state/bhfarm in $HOME or, if that is not set, in the user's own home; XDG_CACHE_HOME
/// likewise. Throws Error where there is none of them.
fs::path state_folder();
fs::path cache_folder();

} // namespace farm
#endif
