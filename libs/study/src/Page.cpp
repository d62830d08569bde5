#include "slamot/study/Page.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <thread>
#include <vector>

#include "MarkdownText.h"
#include "SectionReader.h"
#include "slamot/core/Version.h"
#include "slamot/rawlog/PartFile.h"
#include "slamot/report/Figure.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/study/Figures.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;

std::string processorName() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0 && line.find(':') != std::string::npos)
            return trimmed(line.substr(line.find(':') + 1));
    return "unknown processor";
}

/// As they are: those of Windows end with a carriage return.
std::vector<std::string> linesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw ConfigError(fmt::format("{}: the page cannot be read", file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// "3 failed, 1 truncated": rows of runs that did not reach the end of their log.
std::string otherEndings(const std::vector<Row>& rows) {
    std::vector<std::string> counts;
    for (const char* status : {"failed", "truncated", "corrupt", "stopped"}) {
        const auto count =
            std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return row.status == status; });
        if (count > 0) counts.push_back(fmt::format("{} {}", count, status));
    }
    return fmt::format("{}", fmt::join(counts, ", "));
}

/// By name: the sentences of Plan::skipped hold paths of this machine.
std::vector<std::string> sourcesWithoutWorld(const Plan& plan) {
    std::set<std::string> with;
    for (const WorldPlan& world : plan.worlds) with.insert(plan.sourceOf(world).name);
    std::vector<std::string> without;
    for (const Source& source : plan.study.sources)
        if (with.count(source.name) == 0) without.push_back(source.name);
    return without;
}

/// "NAME table TABLE" of `<!-- KEYWORD NAME table TABLE -->`, words one blank apart; empty for any other
/// line.
std::string markOf(const std::string& line, const std::string& keyword) {
    std::istringstream in(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    if (words.size() < 4 || words[0] != "<!--" || words[1] != keyword || words.back() != "-->") return {};
    return fmt::format("{}", fmt::join(words.begin() + 2, words.end() - 1, " "));
}

/// The words of a mark behind the name, which may hold blanks; nothing where it is another name.
std::optional<std::vector<std::string>> wordsBehind(const std::string& name, const std::string& mark) {
    if (mark.rfind(name, 0) != 0) return std::nullopt;
    if (mark.size() > name.size() && mark[name.size()] != ' ') return std::nullopt;
    std::istringstream in(mark.substr(name.size()));
    return std::vector<std::string>{std::istream_iterator<std::string>(in), {}};
}

/// A file's name as the target of a Markdown link, which ends at a blank.
std::string linkTarget(const std::string& name) {
    std::string target;
    for (const char c : name)
        if (std::string(" ()<>%").find(c) != std::string::npos)
            target += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        else
            target += c;
    return target;
}

std::string withLineEndsOf(const std::string& line, const std::string& content) {
    if (line.empty() || line.back() != '\r') return content;
    std::string text;
    for (const char c : content) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return text;
}

/// Makes the content of one mark; figures wait until the whole page is known to be good.
class Filler {
  public:
    Filler(const fs::path& page, const Findings& findings, const Provenance& provenance,
           const CheckReport* checks)
        : page_(page), findings_(findings), provenance_(provenance), checks_(checks) {}

    /// `words` follow the study's name. Ends with a newline.
    std::string content(const std::vector<std::string>& words) {
        const Analysis& analysis = findings_.analysis;
        if (words.size() == 2 && words[0] == "table")
            return toMarkdown(makeTable(analysis.table(words[1]), findings_));
        if (words.size() == 2 && words[0] == "figure") {
            const PlotSpec& spec = analysis.plot(words[1]);
            const std::string stem = page_.stem().string() + "_" + spec.name;
            drawings_.push_back({&spec, page_.parent_path() / stem});
            return fmt::format("![{}]({}.svg)\n", markdownText(spec.title.empty() ? spec.name : spec.title),
                               linkTarget(stem));
        }
        if (words == std::vector<std::string>{"stamp"}) return stampLine(provenance_, findings_) + "\n";
        if (words == std::vector<std::string>{"checks"} && checks_) return toMarkdown(checkTable(*checks_));
        throw ConfigError(
            checks_ || words != std::vector<std::string>{"checks"}
                ? fmt::format("'{}' is no mark, expected table NAME, figure NAME, checks or stamp",
                              fmt::join(words, " "))
                : "the checks of the study were not made, expected no mark 'checks'");
    }

    void draw() const {
        for (const auto& [spec, stem] : drawings_)
            report::writeFigure(makeFigure(*spec, findings_), stem, {false, true, false});
    }

  private:
    fs::path page_;
    const Findings& findings_;
    const Provenance& provenance_;
    const CheckReport* checks_;
    std::vector<std::pair<const PlotSpec*, fs::path>> drawings_;
};

}  // namespace

Provenance provenanceHere(const std::string& command) {
    return {fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))), processorName(),
            std::thread::hardware_concurrency(), command};
}

std::string originText(const Provenance& p, const Findings& findings) {
    const auto& rows = findings.rows;
    std::set<std::string> hosts;
    for (const Row& row : rows)
        if (!row.cost.host.empty()) hosts.insert(row.cost.host);
    const Plan* plan = findings.plan;
    std::string line =
        fmt::format("{}, {}, {} {}, slamot {}, from {}{} runs", p.date, p.processor, p.cores,
                    p.cores == 1 ? "core" : "cores", version, rows.size(),
                    plan && plan->runCount() > rows.size() ? fmt::format(" of {}", plan->runCount()) : "");
    std::vector<std::string> remarks;
    if (const std::string endings = otherEndings(rows); !endings.empty()) remarks.push_back(endings);
    if (plan && !plan->skipped.empty())
        remarks.push_back(fmt::format("no runs of: {}", fmt::join(sourcesWithoutWorld(*plan), ", ")));
    if (!remarks.empty()) line += fmt::format(" ({})", fmt::join(remarks, "; "));
    if (hosts.size() > 1) line += fmt::format(" on {} machines", hosts.size());
    return line;
}

std::string stampLine(const Provenance& p, const Findings& findings) {
    // Backticks within code need a longer fence.
    const char* fence = p.command.find('`') == std::string::npos ? "`" : "``";
    return fmt::format("Filled on {0}: {1}{2}{1}", originText(p, findings), fence, p.command);
}

std::string filledText(const std::string& page, const std::string& keyword, const std::string& name,
                       const MarkContent& content) {
    const std::vector<std::string> lines = linesOf(page);
    std::string text;
    bool any = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        text += lines[i] + '\n';
        const auto words = wordsBehind(name, markOf(lines[i], keyword));
        if (!words) continue;
        any = true;
        const auto fail = [&](const std::string& problem) {
            throw ConfigError(fmt::format("{}:{}: {}", page, i + 1, problem));
        };
        std::size_t end = i + 1;
        while (end < lines.size() && trimmed(lines[end]) != "<!-- end -->" &&
               markOf(lines[end], keyword).empty())
            ++end;
        if (end == lines.size() || !markOf(lines[end], keyword).empty())
            fail(fmt::format("'{}' has no end, expected <!-- end --> before the next mark",
                             trimmed(lines[i])));
        try {
            text += withLineEndsOf(lines[i], content(*words));
        } catch (const ConfigError& error) {
            fail(error.what());
        }
        i = end - 1;
    }
    if (!any)
        throw ConfigError(fmt::format("{}: has no mark of the {} '{}', expected <!-- {} {} table NAME -->",
                                      page, keyword, name, keyword, name));
    return text;
}

void writePage(const std::string& page, const std::string& text) {
    // Of a link, the page it leads to is filled.
    const fs::path target = fs::canonical(page);
    const fs::perms mode = fs::status(target).permissions();
    PartFile file(target.string());
    file.write(text);
    file.close();
    fs::permissions(target, mode);
}

void fillPage(const std::string& page, const Findings& findings, const Provenance& provenance,
              const CheckReport* checks) {
    Filler filler(fs::weakly_canonical(page), findings, provenance, checks);
    const std::string text = filledText(page, "study", findings.study.name,
                                        [&](const auto& words) { return filler.content(words); });
    filler.draw();
    writePage(page, text);
}

}  // namespace slamot::study
