// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/store/database.h"

#include "distribute/common/error.h"

#include <sqlite3.h>

namespace farm {

Database::Database(const std::filesystem::path& file) {
	if (sqlite3_open_v2(file.c_str(), &handle, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr) !=
		SQLITE_OK) {
		const std::string why = sqlite3_errmsg(handle);
		sqlite3_close(handle);
		throw Error("cannot open the ledger " + file.string() + ": " + why);
	}
	sqlite3_busy_timeout(handle, 10000);
	try {
		for (const char* wish : {"PRAGMA journal_mode=WAL", "PRAGMA synchronous=FULL", "PRAGMA foreign_keys=ON"})
			execute(wish);
	} catch (const Error&) {
		const std::string why = sqlite3_errmsg(handle);
		sqlite3_close(handle);
		throw Error("cannot use the ledger " + file.string() + ": " + why);
	}
}

Database::~Database() { sqlite3_close(handle); }

void Database::execute(const char* sql) {
	char* why = nullptr;
	if (sqlite3_exec(handle, sql, nullptr, nullptr, &why) != SQLITE_OK) {
		const std::string text = why ? why : "?";
		sqlite3_free(why);
		throw Error("the ledger: " + text);
	}
}

std::int64_t Database::last_id() const { return sqlite3_last_insert_rowid(handle); }
int Database::changed() const { return sqlite3_changes(handle); }

std::string Database::damage() {
	std::string found;
	for (const char* check : {"PRAGMA integrity_check", "PRAGMA foreign_key_check"}) {
		Statement s(*this, check);
		while (s.step())
			if (const std::string line = s.text(0); line != "ok")
				found += (found.empty() ? "" : "; ") + line;
	}
	return found;
}

Statement::Statement(Database& d, const char* sql) : database(d) {
	if (sqlite3_prepare_v2(d.handle, sql, -1, &statement, nullptr) != SQLITE_OK)
		throw Error(std::string("the ledger: ") + sqlite3_errmsg(d.handle));
}

Statement::~Statement() { sqlite3_finalize(statement); }

Statement& Statement::operator<<(std::int64_t value) {
	sqlite3_bind_int64(statement, ++bound, value);
	return *this;
}

Statement& Statement::operator<<(double value) {
	sqlite3_bind_double(statement, ++bound, value);
	return *this;
}

Statement& Statement::operator<<(std::string_view value) {
	sqlite3_bind_text(statement, ++bound, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
	return *this;
}

bool Statement::step() {
	switch (sqlite3_step(statement)) {
	case SQLITE_ROW:
		return true;
	case SQLITE_DONE:
		return false;
	default:
		throw Error(std::string("the ledger: ") + sqlite3_errmsg(database.handle));
	}
}

void Statement::run() {
	while (step()) {
	}
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement, column); }
double Statement::real(int column) const { return sqlite3_column_double(statement, column); }

std::string Statement::text(int column) const {
	const auto* text = sqlite3_column_text(statement, column);
	return text ? std::string(reinterpret_cast<const char*>(text), static_cast<size_t>(sqlite3_column_bytes(statement, column)))
				: "";
}

} // namespace farm
