#include "Sqlite.h"

#include <fmt/format.h>

#include "slamot/rawlog/LogError.h"

namespace slamot::study {

Database::Database(const std::string& file) : file_(file) {
    sqlite3* handle = nullptr;
    const int code =
        sqlite3_open_v2(file.c_str(), &handle, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
    handle_.reset(handle);
    if (code != SQLITE_OK) fail();
    // Other programs may be writing to the same file.
    sqlite3_busy_timeout(handle, 30000);
}

void Database::execute(const std::string& sql) {
    if (sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

void Database::fail() const {
    const bool other_form = sqlite3_errcode(handle_.get()) == SQLITE_NOTADB;
    throw LogError(fmt::format("{}: {}{}", file_, sqlite3_errmsg(handle_.get()),
                               other_form ? ", expected a file of rows of a study" : ""));
}

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
    sqlite3_stmt* statement = nullptr;
    check(sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &statement, nullptr));
    statement_.reset(statement);
}

Statement& Statement::bind(int parameter, const std::string& text) {
    check(sqlite3_bind_text(statement_.get(), parameter, text.data(), static_cast<int>(text.size()),
                            SQLITE_TRANSIENT));
    return *this;
}

Statement& Statement::bind(int parameter, std::int64_t value) {
    check(sqlite3_bind_int64(statement_.get(), parameter, value));
    return *this;
}

Statement& Statement::bindBlob(int parameter, const std::string& bytes) {
    check(sqlite3_bind_blob(statement_.get(), parameter, bytes.data(), static_cast<int>(bytes.size()),
                            SQLITE_TRANSIENT));
    return *this;
}

bool Statement::step() {
    const int code = sqlite3_step(statement_.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail();
    return code == SQLITE_ROW;
}

void Statement::reset() {
    check(sqlite3_reset(statement_.get()));
}

std::string Statement::text(int column) const {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
    return {bytes ? bytes : "", static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}

void Statement::check(int code) {
    if (code != SQLITE_OK) database_.fail();
}

Transaction::Transaction(Database& database) : database_(database) {
    database.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
    if (open_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
    database_.execute("COMMIT");
    open_ = false;
}

Attached::Attached(Database& database, const std::string& file) : database_(database) {
    Statement(database, "ATTACH ? AS other").bind(1, file).step();
}

Attached::~Attached() {
    sqlite3_exec(database_.handle(), "DETACH other", nullptr, nullptr, nullptr);
}

}  // namespace slamot::study
