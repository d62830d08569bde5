#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

#include "StudyFolder.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/study/Session.h"
#include "support/Expect.h"

namespace slamot::study {
namespace session_test {

using testing::ElementsAre;
using testing::HasSubstr;

/// Root may write everywhere: for a while, this program is somebody else.
class AsNobody {
  public:
    AsNobody() : uid_(geteuid()) {
        if (uid_ == 0 && seteuid(65534) != 0) ADD_FAILURE() << "cannot become another user";
    }
    ~AsNobody() {
        if (uid_ == 0 && seteuid(0) != 0) std::abort();
    }

  private:
    uid_t uid_;
};

class SessionTest : public StudyFolder {
  protected:
    ~SessionTest() override { std::filesystem::permissions(folder.path(), std::filesystem::perms(0755)); }

    SessionRequest request(const std::string& store = "a.db") const {
        SessionRequest request;
        request.study_file = folder.write("small.ini", usual("2"));
        request.store_file = folder.path(store);
        return request;
    }
    /// Rows of the first `runs` runs.
    void fill(const SessionRequest& wanted, std::size_t runs) const {
        Session session(wanted, registry());
        const std::vector<Row> rows = run(session.plan());
        for (std::size_t i = 0; i < runs; ++i) session.store().add(rows.at(i));
    }
    void protect(const std::string& store, int of_folder) const {
        namespace fs = std::filesystem;
        fs::permissions(folder.path(store), fs::perms(0444));
        fs::permissions(folder.path(), fs::perms(of_folder));
    }
};

TEST_F(SessionTest, RowsThatMayNotBeWrittenCanBeRead) {
    const SessionRequest wanted = request("a?b #%.db");
    fill(wanted, 8);
    for (const int of_folder : {0555, 0755}) {
        protect("a?b #%.db", of_folder);
        const AsNobody nobody;
        Session session(wanted, registry());
        EXPECT_TRUE(session.store().readOnly());
        EXPECT_TRUE(session.isComplete());
        EXPECT_EQ(session.rows().size(), 8u);
        EXPECT_TRUE(session.missing({}).empty());
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4)
        << "the study's three files and the rows: nothing was left beside them";
}

TEST_F(SessionTest, RowsThatSomebodyElseIsWritingAreReadAsTheyCome) {
    const SessionRequest wanted = request();
    fill(wanted, 7);
    Session writer(wanted, registry());
    const std::vector<Row> all = run(writer.plan());
    protect("a.db", 0755);
    std::optional<Session> reader;
    {
        const AsNobody nobody;
        reader.emplace(wanted, registry());
        EXPECT_TRUE(reader->store().readOnly());
        EXPECT_EQ(reader->rows().size(), 7u);
    }
    for (const Row& row : all) writer.store().add(row);
    const AsNobody nobody;
    EXPECT_EQ(reader->rows().size(), 8u);
}

TEST_F(SessionTest, RowsThatWouldHaveToBeWrittenAreASentence) {
    const SessionRequest wanted = request();
    fill(wanted, 7);
    protect("a.db", 0555);
    const AsNobody nobody;
    Session session(wanted, registry());
    EXPECT_EQ(session.rows().size(), 7u);
    EXPECT_THAT(
        test::messageOf<LogError>([&] { session.missing({}); }),
        HasSubstr("a.db: runs are missing, but file or folder may not be written to, expected --no-run"));
    EXPECT_THAT(test::messageOf<LogError>([&] { session.merge({wanted.store_file}); }),
                HasSubstr("a.db: file or folder may not be written to"));
    EXPECT_THAT(test::messageOf<LogError>([&] { session.store().add(session.rows().front()); }),
                HasSubstr("may not be written to"));
}

TEST_F(SessionTest, RowsOfAnotherFolderThatMayNotBeWrittenAreMerged) {
    fill(request("shard.db"), 8);
    SessionRequest mine = request();
    std::filesystem::create_directory(folder.path("mine"));
    if (geteuid() == 0) {
        ASSERT_EQ(chown(folder.path("mine").c_str(), 65534, 65534), 0);
    }
    mine.store_file = folder.path("mine/a.db");
    protect("shard.db", 0555);
    const AsNobody nobody;
    Session session(mine, registry());
    EXPECT_TRUE(session.merge({folder.path("shard.db")}).empty());
    EXPECT_TRUE(session.isComplete());
}

TEST_F(SessionTest, ARequestThatContradictsItselfIsRefused) {
    SessionRequest wanted = request();
    wanted.short_form = true;
    wanted.replicates = 5;
    EXPECT_THAT(test::messageOf<ConfigError>([&] { planOf(wanted, registry()); }),
                HasSubstr("--short and --replicates both say how many worlds"));
}

TEST(ArgumentsOf, HasAllThatDecidesTheRows) {
    SessionRequest wanted;
    wanted.study_file = "a b.ini";
    wanted.store_file = "c.db";
    EXPECT_THAT(argumentsOf(wanted), ElementsAre("a b.ini", "--db", "c.db"));
    wanted.replicates = 7;
    wanted.any_build = true;
    EXPECT_THAT(argumentsOf(wanted),
                ElementsAre("a b.ini", "--db", "c.db", "--replicates", "7", "--any-build"));
    wanted.short_form = true;
    wanted.replicates.reset();
    EXPECT_THAT(argumentsOf(wanted), ElementsAre("a b.ini", "--db", "c.db", "--short", "--any-build"));
}

TEST(TimesInWords, HasNoQuotientOfNothing) {
    StudyProgress progress;
    EXPECT_EQ(timesInWords(progress, 2, 0, 1), "nothing was run, in 2.0 s");
    progress.done = progress.failed = 3;
    EXPECT_EQ(timesInWords(progress, 2, 0, 1), "3 runs, 3 failed, in 2.0 s");
    // Two threads for 2 s are 4 s, of which 3.2 s were runs: 0.8 / 3.2.
    EXPECT_EQ(
        timesInWords(progress, 2, 3.2, 2),
        "3 runs, 3 failed, in 2.0 s; runs took 3.2 s, so speed-up 1.60 on 2 threads, engine and waiting "
        "25.0 % of the runs");
}

TEST(ShellLine, QuotesWhatAShellWouldTakeApart) {
    EXPECT_EQ(shellLine({"slamot", "a/b-c_d.ini", "x=1,2"}), "slamot a/b-c_d.ini x=1,2");
    EXPECT_EQ(shellLine({"a b", "", "it's", "$HOME", "ü*"}), "'a b' '' 'it'\\''s' '$HOME' 'ü*'");
}

}  // namespace session_test
}  // namespace slamot::study
