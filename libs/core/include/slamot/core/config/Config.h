#pragma once
// Config files, read strictly: INI with MRPT's extensions (`//` and `;` comments, `@define`, `${}`), where an
// unknown or doubled key, a value that does not parse whole, or a value out of range is an error that names
// file, line, key and what was expected.
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "slamot/core/config/Parameters.h"

namespace slamot {

/// A mistake in a config, as one sentence a user can act on.
class ConfigError : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

/// Sections of keys with text values, each knowing where it came from.
class Config {
   public:
    struct Entry {
        std::string value;
        /// "file.ini:12" or "--set"; for messages.
        std::string origin;
    };
    using Section = std::map<std::string, Entry>;

    Config() = default;
    /// Throws ConfigError for a missing file, a line that is no INI, a key before any section, a doubled section
    /// or key.
    static Config fromFile(const std::string& path);
    static Config fromText(const std::string& text, const std::string& name = "text");

    /// Sets one value; a later one replaces an earlier one.
    void set(const std::string& section, const std::string& key, const std::string& value,
             const std::string& origin = "program");
    /// `section.key=value`, split at the first `=`, then at the last `.` of what stands before it.
    void setFromAssignment(const std::string& assignment);

    bool has(const std::string& section) const { return sections_.count(section) > 0; }
    /// Empty for a section that is not there.
    const Section& section(const std::string& name) const;
    std::vector<std::string> sectionNames() const;
    /// Where a section starts, for messages.
    std::string origin(const std::string& section) const;
    /// As INI text, sections and keys sorted: equal configs give equal text (run hashes are made from it).
    std::string canonicalText() const;
    /// Folder that relative paths in this config refer to: its file's, unless it was set.
    const std::string& folder() const { return folder_; }
    void setFolder(const std::string& folder) { folder_ = folder; }

   private:
    std::map<std::string, Section> sections_;
    std::map<std::string, std::string> section_origins_;
    std::string folder_ = ".";
};

/// Takes `config`'s section into the fields of `table`. Absent keys keep their defaults. Throws ConfigError.
void load(const ParameterTable& table, const Config& config);

/// Throws ConfigError for a section that is none of `known` (exact names) and does not start with one of
/// `open_prefixes` (sections whose names users choose).
void requireKnownSections(const Config& config, const std::vector<std::string>& known,
                          const std::vector<std::string>& open_prefixes = {});

}  // namespace slamot
