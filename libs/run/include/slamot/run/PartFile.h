#pragma once
#include <fstream>
#include <string>
#include <string_view>

namespace slamot::run {

/// A file written as NAME.part and renamed by `close`: a crash leaves what was written, readable to its last
/// full line, and never a file that looks finished.
class PartFile {
   public:
    explicit PartFile(const std::string& file);
    void line(const std::string& text) { write(text + '\n'); }
    /// Throws LogError as soon as the disk takes no more.
    void write(std::string_view bytes);
    void close();

   private:
    [[noreturn]] void failToWrite() const;

    std::string file_;
    std::ofstream out_;
};

}  // namespace slamot::run
