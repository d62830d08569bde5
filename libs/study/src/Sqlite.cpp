#include "Sqlite.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "slamot/rawlog/LogError.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

bool mayWrite(const fs::path& path) {
    return faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
}

/// Whether SQLite can make, or finds, the files beside it that it needs; other mistakes come to light, with
/// their message, when the file is read.
bool opens(const std::string& uri) {
    sqlite3* handle = nullptr;
    int code = sqlite3_open_v2(uri.c_str(), &handle, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    // The file itself is not touched before it is read.
    if (code == SQLITE_OK) {
        sqlite3_exec(handle, "SELECT 1 FROM sqlite_master LIMIT 1", nullptr, nullptr, nullptr);
        code = sqlite3_extended_errcode(handle);
    }
    sqlite3_close(handle);
    return (code & 0xff) != SQLITE_CANTOPEN && code != SQLITE_READONLY_DIRECTORY;
}

/// https://www.sqlite.org/uri.html
std::string uriOf(const std::string& file, bool read_only) {
    std::string uri = "file:";
    for (const char c : file)
        if (c == '%' || c == '?' || c == '#')
            uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
        else
            uri += c;
    if (!read_only) return uri + "?mode=rwc";
    // Even to read, SQLite wants a -wal and a -shm. They are there while somebody has the file open, who may
    // write: then it is read with locks. Otherwise it is read as one that does not change: files of this user
    // made beside it would stay, and the next who writes may not write to them. Never past rows in a -wal.
    std::error_code none;
    const auto in_wal = fs::file_size(file + "-wal", none);
    const bool with_locks = !none && (in_wal > 0 || opens(uri + "?mode=ro"));
    return uri + (with_locks ? "?mode=ro" : "?immutable=1");
}

}  // namespace

bool isReadOnly(const std::string& file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return false;
    return !mayWrite(file) || !mayWrite(fs::absolute(file).parent_path());
}

Database::Database(const std::string& file) : file_(file), read_only_(isReadOnly(file)) {
    sqlite3* handle = nullptr;
    const int how = read_only_ ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
    const int code =
        sqlite3_open_v2(uriOf(file, read_only_).c_str(), &handle, how | SQLITE_OPEN_URI, nullptr);
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
    Statement(database, "ATTACH ? AS other").bind(1, uriOf(file, isReadOnly(file))).step();
}

Attached::~Attached() {
    sqlite3_exec(database_.handle(), "DETACH other", nullptr, nullptr, nullptr);
}

}  // namespace slamot::study
