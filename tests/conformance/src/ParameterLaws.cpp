#include <slamot/core/config/Config.h>

#include "conformance/Play.h"
#include "conformance/src/Guarded.h"

namespace slamot::conformance {
namespace {

constexpr const char* nonsense = "~ no value ~";

bool belongs(const std::string& section, const std::string& plugin) {
    return section == plugin || section.rfind(plugin + ".", 0) == 0 || section == "motion";
}

Verdict checkParameter(const std::string& section, const Parameter& parameter) {
    const std::string name = fmt::format("[{}] {}", section, parameter.key), before = parameter.print();
    if (parameter.help.empty() || parameter.expected.empty())
        return name + " lacks its help or what is expected";
    if (const auto reason = parameter.parse(before))
        return fmt::format("{} prints '{}' and refuses it: expected {}", name, before, *reason);
    if (parameter.print() != before)
        return fmt::format("{} printed '{}', parsed it, and now prints '{}'", name, before,
                           parameter.print());
    const bool takes_any_text = parameter.expected == "text";
    if (!takes_any_text && !parameter.parse(nonsense)) return fmt::format("{} takes '{}'", name, nonsense);
    if (!takes_any_text && parameter.print() != before) return name + " changed though it refused its value";
    return {};
}

}  // namespace

Verdict parametersRoundTrip(const Options& options) {
    return guarded([&]() -> Verdict {
        const auto first = createSubject(options), second = createSubject(options);
        first->initialize(Config::fromText(options.config, "conformance options"));
        std::string text;
        for (const ParameterTable& table : first->parameterTables()) {
            if (!belongs(table.section(), first->name()))
                return fmt::format("section [{}] is neither [{}] nor a part of it", table.section(),
                                   first->name());
            for (const Parameter& parameter : table.parameters())
                if (Verdict verdict = checkParameter(table.section(), parameter); !verdict.empty())
                    return verdict;
            text += toIni(table) + "\n";
        }
        second->initialize(Config::fromText(text, "printed parameters"));
        std::string again;
        for (const ParameterTable& table : second->parameterTables()) again += toIni(table) + "\n";
        if (again != text)
            return "parameters printed, loaded into a new object and printed again differ:\n" + again;
        return {};
    });
}

Verdict unknownKeyIsRefused(const Options& options) {
    return guarded([&]() -> Verdict {
        for (const ParameterTable& table : createSubject(options)->parameterTables()) {
            const std::string key = "no_such_key";
            Config config;
            config.set(table.section(), key, "1");
            try {
                createSubject(options)->initialize(config);
            } catch (const ConfigError& error) {
                if (std::string(error.what()).find(key) != std::string::npos) continue;
                return fmt::format("the refusal of an unknown key does not name it: {}", error.what());
            }
            return fmt::format("[{}] takes the unknown key '{}'", table.section(), key);
        }
        return {};
    });
}

}  // namespace slamot::conformance
