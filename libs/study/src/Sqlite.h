#pragma once
// SQLite with exceptions and owned handles.
#include <sqlite3.h>

#include <memory>
#include <string>

namespace slamot::study {

class Database;

/// One prepared statement; parameters and columns are numbered from 1 and 0, as SQLite does.
class Statement {
  public:
    Statement(Database& database, const std::string& sql);
    Statement& bind(int parameter, const std::string& text);
    Statement& bind(int parameter, std::int64_t value);
    Statement& bindBlob(int parameter, const std::string& bytes);
    /// Whether there is a row.
    bool step();
    void reset();
    std::string text(int column) const;
    std::int64_t integer(int column) const;

  private:
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    void check(int code);
    Database& database_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

class Database {
  public:
    /// Opens or creates. Throws LogError naming the file, as everything here does.
    explicit Database(const std::string& file);
    void execute(const std::string& sql);
    [[noreturn]] void fail() const;
    sqlite3* handle() const { return handle_.get(); }
    const std::string& file() const { return file_; }

  private:
    struct Close {
        void operator()(sqlite3* handle) const { sqlite3_close(handle); }
    };
    std::string file_;
    std::unique_ptr<sqlite3, Close> handle_;
};

/// What is done until commit() is done as a whole or not at all.
class Transaction {
  public:
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

  private:
    Database& database_;
    bool open_ = true;
};

/// Another file under the name `other`. Statements and transactions on it must end before.
class Attached {
  public:
    Attached(Database& database, const std::string& file);
    ~Attached();
    Attached(const Attached&) = delete;
    Attached& operator=(const Attached&) = delete;

  private:
    Database& database_;
};

}  // namespace slamot::study
