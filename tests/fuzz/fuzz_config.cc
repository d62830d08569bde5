// Any text is a config or a ConfigError; a config's canonical text is a config again.
#include "slamot/core/config/Config.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    double real = 0;
    bool flag = false;
    std::vector<double> reals;
    slamot::ParameterTable table("a", "");
    table.real("angle_deg", real, "deg", slamot::Interval::between(-180, 180), "")
        .reals("b", reals, "m", slamot::Interval::any(), "")
        .flag("c", flag, "");
    try {
        slamot::Config config = slamot::Config::fromText(text, "fuzz.ini");
        config.setFromAssignment(text.substr(0, 40));
        slamot::load(table, config);
        slamot::requireKnownSections(config, {"a", "run"}, {"noise."});
        for (const auto& parameter : table.parameters())
            if (parameter.parse(parameter.print())) __builtin_trap();
    } catch (const slamot::ConfigError&) {
    }
    return 0;
}
