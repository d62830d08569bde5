#pragma once
#include <fstream>
#include <string>
#include <string_view>

namespace slamot {

/// Where a file or folder is written until it is whole: a crash leaves what was written under this name, and
/// never anything that looks finished.
std::string partOf(const std::string& file);
/// Gives what stands there its final name. Throws LogError.
void finishPart(const std::string& file);

/// A file that has its name once it is closed; until then its part is readable to the last full line.
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

}  // namespace slamot
