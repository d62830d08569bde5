#include "page/CompactSpec.h"

#include <cmath>
#include <cstdio>
#include <set>

namespace slamot::report {
namespace {

using nlohmann::json;

/// How a column of numbers is rounded: digits after the point on a linear axis, significant ones on a
/// logarithmic one.
struct Rounding {
    bool significant = false;
    int digits = 6;

    double operator()(double value) const {
        if (!significant || value == 0) {
            return rounded(value, digits);
        }
        return rounded(value, digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
    }
};

Rounding roundingOf(const json& axis, double pixels) {
    if (axis.at("log").get<bool>()) {
        return {true, 5};
    }
    const double extent = axis.at("domain")[1].get<double>() - axis.at("domain")[0].get<double>();
    return {false, static_cast<int>(std::ceil(-std::log10(extent / pixels / 100)))};
}

json column(const json& rows, const std::string& name, const Rounding& rounding) {
    json values = json::array();
    for (const json& row : rows) {
        const json& value = row.at(name);
        if (!value.is_number()) {
            values.push_back(value);
            continue;
        }
        const double number = rounding(value.get<double>());
        // 12 is shorter than 12.0 and the same to a browser.
        const bool whole = std::abs(number) < 1e15 && number == std::floor(number);
        values.push_back(whole ? json(static_cast<std::int64_t>(number)) : json(number));
    }
    return values;
}

}  // namespace

double rounded(double value, int digits) {
    if (!std::isfinite(value) || digits > 300) {
        return value;
    }
    // Through text: a product with a power of ten would leave digits behind.
    if (digits >= 0) {
        char text[512];
        std::snprintf(text, sizeof text, "%.*f", std::min(digits, 100), value);
        return std::strtod(text, nullptr);
    }
    const double unit = std::pow(10, -digits);
    return std::round(value / unit) * unit;
}

json compactSpec(json spec) {
    const json& panels = spec.at("usermeta").at("panels");
    std::size_t symbols = 0;
    std::set<std::string> symbol_data;
    for (const json& group : spec.at("marks")) {
        for (const json& mark : group.value("marks", json::array())) {
            if (mark.at("type") == "symbol" && mark.contains("from")) {
                symbol_data.insert(mark.at("from").at("data").get<std::string>());
            }
        }
    }
    for (json& set : spec.at("data")) {
        const std::string name = set.at("name");
        const json& panel = panels.at(std::stoul(name.substr(1)));  // p<i>_l<j>
        const Rounding x = roundingOf(panel.at("x"), panel.at("width")),
                       y = roundingOf(panel.at("y"), panel.at("height"));
        const json rows = std::move(set.at("values"));
        symbols += symbol_data.count(name) > 0 ? rows.size() : 0;
        json columns = json::array(), values = json::array();
        if (!rows.empty()) {
            for (const auto& [key, ignored] : rows.front().items()) {
                columns.push_back(key);
                values.push_back(column(rows, key, key == "x" || key == "from" || key == "to" ? x : y));
            }
        }
        set.erase("values");
        set["columns"] = std::move(columns);
        set["values"] = std::move(values);
    }
    spec["usermeta"]["symbols"] = symbols;
    return spec;
}

}  // namespace slamot::report
