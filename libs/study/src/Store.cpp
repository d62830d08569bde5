#include "slamot/study/Store.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>

#include "FileLock.h"
#include "RowJson.h"
#include "Sqlite.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::study {
namespace {

constexpr const char* format = "slamot study 1";
// Text where a person or another program may look (SQLite reads JSON); series are CBOR, since they are long.
constexpr const char* schema =
    "CREATE TABLE IF NOT EXISTS study (name TEXT, format TEXT);"
    "CREATE TABLE IF NOT EXISTS rows (key TEXT PRIMARY KEY, source TEXT, scenario_point TEXT, variant TEXT,"
    " config_point TEXT, replicate INTEGER, world_seed TEXT, estimator_seed TEXT, status TEXT, reason TEXT,"
    " estimate_hash TEXT, metrics TEXT, series BLOB, cost TEXT, build TEXT) WITHOUT ROWID;";
constexpr const char* columns =
    "key, source, scenario_point, variant, config_point, replicate, world_seed, estimator_seed, status, "
    "reason,"
    " estimate_hash, metrics, series, cost, build";

std::string cbor(const nlohmann::json& json) {
    std::string bytes;
    nlohmann::json::to_cbor(json, bytes);
    return bytes;
}

Row rowOf(const Statement& s) {
    using nlohmann::json;
    Row row;
    row.key = s.text(0);
    row.source = s.text(1);
    row.scenario_point = pointFrom(json::parse(s.text(2)));
    row.variant = s.text(3);
    row.config_point = pointFrom(json::parse(s.text(4)));
    row.replicate = static_cast<int>(s.integer(5));
    row.world_seed = std::stoull(s.text(6));
    row.estimator_seed = std::stoull(s.text(7));
    row.status = s.text(8);
    row.reason = s.text(9);
    row.estimate_hash = s.text(10);
    row.metrics = metricsFrom(json::parse(s.text(11)));
    row.series = seriesFrom(json::from_cbor(s.text(12)));
    row.cost = costFrom(json::parse(s.text(13)));
    row.build = s.text(14);
    return row;
}

/// Throws when the database is of something else.
void requireStudy(Database& database, const std::string& name) {
    const std::string& file = database.file();
    Statement tables(database, "SELECT count(*) FROM sqlite_master WHERE name IN ('study', 'rows')");
    tables.step();
    if (tables.integer(0) != 2)
        throw LogError(
            fmt::format("{}: is a database of something else, expected a file of rows of a study", file));
    Statement study(database, "SELECT name, format FROM study");
    const bool there = study.step();
    const std::string found_name = there ? study.text(0) : "", found_format = there ? study.text(1) : "";
    if (found_format != format)
        throw LogError(fmt::format("{}: its rows are in another form ('{}'), expected '{}'", file,
                                   found_format, format));
    if (found_name != name)
        throw LogError(
            fmt::format("{}: has the rows of study '{}', expected those of '{}'", file, found_name, name));
}

/// Throws when rows of the plan were made by another build.
void requireSameBuild(Database& database, const Plan& plan) {
    std::map<std::string, std::string> builds;
    Statement all(database, "SELECT key, build FROM rows");
    while (all.step()) builds[all.text(0)] = all.text(1);
    std::size_t there = 0, others = 0;
    for (const WorldPlan& world : plan.worlds)
        for (const RunPlan& run : world.runs) {
            const auto found = builds.find(run.key);
            if (found == builds.end()) continue;
            ++there;
            others += found->second != plan.configs[run.config].build;
        }
    if (others > 0)
        throw LogError(fmt::format(
            "{}: {} of its {} rows of this study were made by another build of the program or its "
            "plugins, expected a new file, or --any-build to keep them",
            database.file(), others, there));
}

}  // namespace

struct Store::Impl {
    Impl(const std::string& file, const StudyFile& study) : database(file), name(study.name) {
        open();
        insert = std::make_unique<Statement>(
            database,
            fmt::format("INSERT OR REPLACE INTO rows ({}) VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)", columns));
        select = std::make_unique<Statement>(database,
                                             fmt::format("SELECT {} FROM rows WHERE key = ?", columns));
    }

    /// Makes the tables in an empty file, and never in a database of something else.
    void open() {
        // SQLite does not wait for another program that changes the same new file to WAL.
        const FileLock lock(std::filesystem::absolute(database.file()).parent_path().string());
        Statement any(database, "SELECT count(*) FROM sqlite_master");
        any.step();
        if (any.integer(0) == 0) {
            any.reset();
            // Readers and a writer at the same time, and a row a commit without waiting for the disk: a kill
            // of the program loses nothing, only a power failure may lose the last rows.
            database.execute("PRAGMA journal_mode = WAL");
            Transaction transaction(database);
            database.execute(schema);
            Statement(database, "INSERT INTO study SELECT ?, ? WHERE NOT EXISTS (SELECT * FROM study)")
                .bind(1, name)
                .bind(2, std::string(format))
                .step();
            transaction.commit();
        }
        requireStudy(database, name);
        database.execute("PRAGMA synchronous = NORMAL");
    }

    std::optional<Row> find(const std::string& key) {
        std::optional<Row> row;
        if (select->bind(1, key).step()) row = rowOf(*select);
        select->reset();
        return row;
    }

    Database database;
    std::string name;
    std::unique_ptr<Statement> insert, select;
};

Store::Store(const std::string& file, const StudyFile& study) : impl_(std::make_unique<Impl>(file, study)) {}
Store::~Store() = default;

void Store::requireBuild(const Plan& plan) const {
    requireSameBuild(impl_->database, plan);
}

std::set<std::string> Store::done(const Plan& plan, bool but_failed) const {
    std::set<std::string> there, keys;
    Statement all(impl_->database, "SELECT key FROM rows WHERE NOT (? AND status = 'failed')");
    all.bind(1, static_cast<std::int64_t>(but_failed));
    while (all.step()) there.insert(all.text(0));
    for (const WorldPlan& world : plan.worlds)
        for (const RunPlan& run : world.runs)
            if (there.count(run.key)) keys.insert(run.key);
    return keys;
}

void Store::add(const Row& row) {
    Transaction transaction(impl_->database);
    if (std::optional<Row> there = impl_->find(row.key); there && there->status != "failed") {
        // What a row is called may have changed with the plan.
        there->source = row.source, there->variant = row.variant, there->replicate = row.replicate;
        there->scenario_point = row.scenario_point, there->config_point = row.config_point;
        if (identity(*there) == identity(row)) return;
        throw LogError(fmt::format(
            "{}: its row {} ({} on {}, replicate {}) differs from the one computed now, expected equal rows",
            impl_->database.file(), row.key.substr(0, 12), row.variant, row.source, row.replicate));
    }
    Statement& s = *impl_->insert;
    s.bind(1, row.key)
        .bind(2, row.source)
        .bind(3, dumped(pointJson(row.scenario_point)))
        .bind(4, row.variant);
    s.bind(5, dumped(pointJson(row.config_point))).bind(6, static_cast<std::int64_t>(row.replicate));
    s.bind(7, std::to_string(row.world_seed)).bind(8, std::to_string(row.estimator_seed));
    s.bind(9, row.status)
        .bind(10, row.reason)
        .bind(11, row.estimate_hash)
        .bind(12, dumped(metricsJson(row.metrics)));
    s.bindBlob(13, cbor(seriesJson(row.series))).bind(14, dumped(costJson(row.cost))).bind(15, row.build);
    s.step();
    s.reset();
    transaction.commit();
}

std::vector<Row> Store::rows(const Plan& plan) const {
    struct Wanted {
        std::size_t source, scenario_point, variant, config_point;
        int replicate;
        const WorldPlan* world;
        const RunPlan* run;
    };
    std::vector<Wanted> wanted;
    for (const WorldPlan& world : plan.worlds)
        for (const RunPlan& run : world.runs)
            wanted.push_back({world.source, world.scenario_point, run.variant, run.config_point,
                              world.replicate, &world, &run});
    std::sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) {
        return std::tie(a.source, a.scenario_point, a.variant, a.config_point, a.replicate) <
               std::tie(b.source, b.scenario_point, b.variant, b.config_point, b.replicate);
    });
    std::vector<Row> found;
    for (const Wanted& one : wanted) {
        std::optional<Row> row = impl_->find(one.run->key);
        if (!row) continue;
        setLabels(*row, plan, *one.world, *one.run);
        found.push_back(std::move(*row));
    }
    return found;
}

std::size_t Store::count() const {
    Statement count(impl_->database, "SELECT count(*) FROM rows");
    count.step();
    return static_cast<std::size_t>(count.integer(0));
}

void Store::merge(const std::string& file, const Plan& plan, bool any_build) {
    Database& database = impl_->database;
    if (!std::filesystem::is_regular_file(file))
        throw LogError(file + ": is not there, expected a file of rows to merge");
    {
        Database other(file);
        requireStudy(other, impl_->name);
        if (!any_build) requireSameBuild(other, plan);
    }
    const Attached attached(database, file);
    Transaction transaction(database);
    Statement conflict(
        database,
        "SELECT a.key, a.source, a.variant, a.replicate FROM main.rows a JOIN other.rows b USING (key)"
        " WHERE a.status != 'failed' AND b.status != 'failed'"
        " AND NOT (a.status = b.status AND a.reason = b.reason AND a.estimate_hash = b.estimate_hash"
        " AND a.metrics = b.metrics AND a.series = b.series)");
    if (conflict.step())
        throw LogError(
            fmt::format("{}: its row {} ({} on {}, replicate {}) differs from that in {}, expected equal "
                        "rows of equal keys",
                        file, conflict.text(0).substr(0, 12), conflict.text(2), conflict.text(1),
                        conflict.text(3), database.file()));
    conflict.reset();
    database.execute(
        "DELETE FROM main.rows WHERE status = 'failed'"
        " AND key IN (SELECT key FROM other.rows WHERE status != 'failed')");
    database.execute(
        fmt::format("INSERT OR IGNORE INTO main.rows ({0}) SELECT {0} FROM other.rows", columns));
    transaction.commit();
}

}  // namespace slamot::study
