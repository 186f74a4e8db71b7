// SPDX-License-Identifier: AGPL-3.0-or-later
/// SQLite, as little of it as the ledger needs.
#ifndef FARM_DATABASE_H
#define FARM_DATABASE_H

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace farm {

class Database;

/// A prepared statement: bind with `<<` from the first parameter on, then `step` row by row and read columns. Throws Error.
class Statement {
public:
	Statement(Database& database, const char* sql);
	~Statement();
	Statement(const Statement&) = delete;
	Statement& operator=(const Statement&) = delete;

	Statement& operator<<(std::int64_t value);
	Statement& operator<<(int value) { return *this << static_cast<std::int64_t>(value); }
	Statement& operator<<(double value);
	Statement& operator<<(std::string_view value);
	/// True while there is a row.
	bool step();
	/// Runs to the end.
	void run();

	std::int64_t integer(int column) const;
	double real(int column) const;
	std::string text(int column) const;

private:
	Database& database;
	sqlite3_stmt* statement = nullptr;
	int bound = 0;
};

/// One connection, for one thread at a time. In WAL mode with synchronous=FULL: what is committed survives a power cut.
class Database {
public:
	explicit Database(const std::filesystem::path& file);
	~Database();
	Database(const Database&) = delete;
	Database& operator=(const Database&) = delete;

	void execute(const char* sql);
	std::int64_t last_id() const;
	int changed() const;
	/// What SQLite's own integrity check says, empty if all is well.
	std::string damage();

private:
	friend class Statement;
	sqlite3* handle = nullptr;
};

} // namespace farm
#endif
