#include "slamot/report/Page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "JsonText.h"
#include "page/Assets.h"
#include "page/CompactSpec.h"
#include "page/Html.h"
#include "slamot/rawlog/PartFile.h"
#include "slamot/report/FigureSpec.h"
#include "slamot/report/FigureWriter.h"

namespace slamot::report {
namespace {

std::string cellTag(const std::string& tag, const std::string& attributes, const std::string& text) {
    return fmt::format("<{}{}>{}</{}>", tag, attributes, escaped(text), tag);
}

std::string html(const PageTable& table) {
    std::string out = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                      escaped(table.caption) + "\"><table><caption>" + escaped(table.caption) +
                      "</caption>\n";
    const auto attributes = [&](std::size_t column) {
        return table.columns.at(column).numeric ? " class=\"number\"" : "";
    };
    out += "<thead><tr>";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        out += cellTag("th", fmt::format(" scope=\"col\"{}", attributes(c)), table.columns[c].heading);
    }
    out += "</tr></thead>\n<tbody>\n";
    for (const TableRow& row : table.rows) {
        if (row.group) {
            out += fmt::format("<tr class=\"group\"><th scope=\"colgroup\" colspan=\"{}\">{}</th></tr>\n",
                               table.columns.size(), escaped(row.cells.at(0).text));
            continue;
        }
        out += row.strong ? "<tr class=\"strong\">" : "<tr>";
        for (std::size_t c = 0; c < row.cells.size(); ++c) {
            const bool best = row.cells[c].best;
            out += c == 0 ? cellTag("th", " scope=\"row\"", row.cells[c].text)
                          : cellTag("td", best ? " class=\"number best\"" : attributes(c), row.cells[c].text);
        }
        out += "</tr>\n";
    }
    return out + "</tbody></table></div>\n";
}

std::string html(const PageFigure& figure) {
    const nlohmann::json spec = compactSpec(figureSpec(figure.figure));
    const double width = spec.at("width");
    std::string out = fmt::format("<figure id=\"figure-{0}\" data-figure=\"{0}\">\n", escaped(figure.name));
    const nlohmann::json& panels = spec.at("usermeta").at("panels");
    const bool takes_keys = std::any_of(panels.begin(), panels.end(), [](const nlohmann::json& panel) {
        return panel.at("x").at("moves").get<bool>();
    });
    out += fmt::format(
        "<div class=\"canvas\" tabindex=\"0\" role=\"{4}\" aria-label=\"{0}\" "
        "style=\"aspect-ratio: {1} / {2}; max-width: {3}px\"></div>\n",
        escaped(figure.alt), width, spec.at("height").get<double>(), std::round(1.1 * width),
        takes_keys ? "group" : "img");
    out +=
        "<div class=\"below\"><details class=\"layers\"><summary>Show or hide</summary><div "
        "class=\"choices\"></div>"
        "</details><output class=\"readout\" aria-live=\"polite\"></output><span "
        "class=\"tools\"></span></div>\n";
    if (!figure.caption.empty()) {
        out += "<figcaption>" + escaped(figure.caption) + "</figcaption>\n";
    }
    return out + "<script type=\"application/json\" class=\"spec\">" + inScript(jsonText(spec)) +
           "</script>\n</figure>\n";
}

std::string html(const Paragraph& paragraph) {
    return "<p>" + escaped(paragraph.text) + "</p>\n";
}

/// `number` makes the element's name within the page.
std::string html(const Verbatim& verbatim, std::size_t number) {
    const std::string id = fmt::format("text-{}", number);
    std::string text = fmt::format("<pre id=\"{}\" tabindex=\"0\">{}</pre>\n", id, escaped(verbatim.text));
    if (verbatim.can_be_copied) {
        text += fmt::format("<button type=\"button\" data-copies=\"{}\">Copy</button>\n", id);
    }
    return verbatim.summary.empty() ? text
                                    : fmt::format("<details><summary>{}</summary>\n{}</details>\n",
                                                  escaped(verbatim.summary), text);
}

/// `data-colour`: a colour that the theme changes (assets/replay.js).
std::string keyDrawing(const ReplayKey& key) {
    using Symbol = ReplayKey::Symbol;
    const char* shape = "";
    switch (key.symbol) {
        case Symbol::arrow:
            shape = R"(<path d="M3 1 L14 4 L3 7 Z" fill="{0}" data-colour="{0}"/>)";
            break;
        case Symbol::square:
            shape = R"(<rect x="6" y="2" width="4" height="4" fill="{0}" data-colour="{0}"/>)";
            break;
        case Symbol::cross:
            shape = R"(<path d="M5 1 L11 7 M5 7 L11 1" stroke="{0}" data-colour="{0}"/>)";
            break;
        case Symbol::wide_line:
            shape = R"(<path d="M0 4 H16" stroke-width="4" opacity="0.35" stroke="{0}" data-colour="{0}"/>)";
            break;
        case Symbol::line:
            shape = R"(<path d="M0 4 H16" stroke="{0}" data-colour="{0}"/>)";
            break;
        case Symbol::disc:
            shape = R"(<circle cx="8" cy="4" r="4" fill="{0}" data-colour="{0}"/>)";
            break;
        case Symbol::frame:
            shape = R"(<rect x="5.5" y="1.5" width="5" height="5" fill="none" stroke="{0}" data-colour="{0}"/>)";
            break;
        case Symbol::dots:
            shape = R"(<path d="M3 3h.1M8 5.5h.1M12 2h.1M10.5 6h.1M6 1.5h.1" stroke-width="3" stroke-linecap="round" )"
                    R"(stroke="{0}" data-colour="{0}"/>)";
            break;
    }
    return fmt::format(fmt::runtime(shape), escaped(key.colour));
}

std::string html(const ReplayView& replay) {
    std::string out = "<div class=\"replay\" data-replay>\n";
    // The group takes the keys; what is seen in it is a picture.
    out += fmt::format(
        "<div class=\"stage\" tabindex=\"0\" role=\"group\" aria-label=\"Replay\">"
        "<canvas role=\"img\" aria-label=\"{}\"></canvas></div>\n",
        escaped(replay.alt));
    out +=
        "<div class=\"time\"><button type=\"button\" class=\"play\">Play</button>"
        "<input type=\"range\" min=\"0\" max=\"1\" step=\"1\" value=\"0\" aria-label=\"Time\">"
        "<label>Speed <select class=\"speed\">";
    for (const int speed : {1, 2, 5, 10, 20, 50, 100}) {
        out += fmt::format("<option value=\"{0}\"{1}>{0} ×</option>", speed, speed == 5 ? " selected" : "");
    }
    out += "</select></label><button type=\"button\" class=\"whole\">Whole map</button></div>\n";
    out += "<p class=\"state\"></p>\n<fieldset><legend>Show:</legend>";
    for (const ReplayChoice& choice : replay.choices) {
        out += fmt::format("<label><input type=\"checkbox\" value=\"{}\"{}> {}</label>", escaped(choice.id),
                           choice.on ? " checked" : "", escaped(choice.label));
    }
    out += "</fieldset>\n";
    out += "<ul class=\"key\" aria-label=\"What is drawn\">";
    for (const ReplayKey& key : replay.keys) {
        out += fmt::format("<li><svg aria-hidden=\"true\" viewBox=\"0 0 16 8\">{}</svg>{}</li>",
                           keyDrawing(key), escaped(key.words));
    }
    out += "</ul>\n";
    if (!replay.note.empty()) {
        out += "<p class=\"note\">" + escaped(replay.note) + "</p>\n";
    }
    return out + "<script type=\"application/json\" class=\"data\">" + inScript(replay.data) +
           "</script>\n</div>\n";
}

std::string html(const PageSection& section, std::size_t& texts) {
    std::string out = fmt::format("<section aria-labelledby=\"{0}\">\n<h2 id=\"{0}\">{1}</h2>\n",
                                  escaped(section.id), escaped(section.title));
    if (!section.about.empty()) {
        out += "<p class=\"about\">" + escaped(section.about) + "</p>\n";
    }
    for (const Block& block : section.blocks) {
        if (const auto* verbatim = std::get_if<Verbatim>(&block)) {
            out += html(*verbatim, texts++);
            continue;
        }
        out += std::visit(
            [](const auto& b) -> std::string {
                if constexpr (std::is_same_v<std::decay_t<decltype(b)>, Verbatim>) {
                    return {};
                } else {
                    return html(b);
                }
            },
            block);
    }
    return out + "</section>\n";
}

std::string contents(const Page& page) {
    std::string out = "<nav aria-label=\"Contents\"><ul>";
    for (const PageSection& section : page.sections) {
        out += fmt::format("<li><a href=\"#{}\">{}</a></li>", escaped(section.id), escaped(section.title));
    }
    return out + "</ul></nav>\n";
}

constexpr const char* controls = R"html(<div class="controls">
<label>Colours <select id="theme"><option value="auto">as the system</option><option value="light">light</option><option value="dark">dark</option></select></label>
<button type="button" id="print">Print</button>
</div>
<noscript><p>The plots of this page are drawn by JavaScript, which is off.</p></noscript>
)html";

}  // namespace

std::string toHtml(const Page& page) {
    std::string out =
        "<!DOCTYPE html>\n<html lang=\"en\" data-theme=\"light\">\n<head>\n<meta charset=\"utf-8\">\n";
    out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
    out += "<title>" + escaped(page.title) + "</title>\n<style>\n";
    out += assets::style();
    out +=
        "</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#content\">To the content</a>\n<header>\n<h1>" +
        escaped(page.title) + "</h1>\n<p class=\"subtitle\">" + escaped(page.subtitle) + "</p>\n";
    out += controls + contents(page) + "</header>\n<main id=\"content\">\n";
    std::size_t texts = 0;
    for (const PageSection& section : page.sections) {
        out += html(section, texts);
    }
    out += "</main>\n<footer><p>" + escaped(page.footer) +
           "</p>\n<details><summary>Licence of Vega</summary><pre tabindex=\"0\">" +
           escaped(assets::vegaLicence()) + "</pre></details></footer>\n";
    out += "<script type=\"application/json\" id=\"dark-colours\">" + nlohmann::json(darkColours()).dump() +
           "</script>\n";
    out += "<script>\n";
    out += assets::vegaBundle();
    out += "</script>\n<script>\n";
    out += assets::scripts();
    return out + "</script>\n</body>\n</html>\n";
}

void writePage(const Page& page, const std::string& file) {
    const std::string text = toHtml(page);
    try {
        PartFile out(file);
        out.write(text);
        out.close();
    } catch (const std::exception& error) {
        throw ReportError(error.what());
    }
}

void writePictures(const Page& page, const std::string& folder) {
    for (const PageSection& section : page.sections) {
        for (const Block& block : section.blocks) {
            if (const auto* figure = std::get_if<PageFigure>(&block)) {
                writeFigure(figure->figure, std::filesystem::path(folder) / figure->name,
                            {false, true, true});
            }
        }
    }
}

}  // namespace slamot::report
