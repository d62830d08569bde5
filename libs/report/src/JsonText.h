#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace slamot::report {

/// On one line. Labels of a log may be no UTF-8: what is none of it becomes U+FFFD.
inline std::string jsonText(const nlohmann::json& json) {
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace slamot::report
