#pragma once
// Tables of numbers between blanks, as research datasets have them.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "slamot/core/data/Stamp.h"

namespace slamot {

/// One line. What a field cannot give is a LogError that names file, line and field.
class ColumnRow {
  public:
    ColumnRow(std::string place, std::vector<std::string> fields)
        : place_(std::move(place)), fields_(std::move(fields)) {}

    Stamp stamp(std::size_t i) const;
    /// Finite.
    double number(std::size_t i) const;
    std::int64_t integer(std::size_t i) const;
    const std::string& text(std::size_t i) const { return fields_[i]; }
    std::size_t size() const { return fields_.size(); }
    [[noreturn]] void fail(std::size_t i, const std::string& expected) const;

  private:
    std::string place_;
    std::vector<std::string> fields_;
};

/// Every line with something before a `#`; each must have at least `columns` fields. `dataset` is named when
/// the file is not there: "the MRCLAM dataset".
void forEachRow(const std::filesystem::path& file, std::size_t columns, const std::string& dataset,
                const std::function<void(const ColumnRow&)>& take);

}  // namespace slamot
