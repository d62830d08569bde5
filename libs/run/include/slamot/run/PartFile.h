#pragma once
#include <fstream>
#include <string>

namespace slamot::run {

/// A text file written as NAME.part and renamed by `close`: a crash leaves what was written, readable to its last
/// full line, and never a file that looks finished.
class PartFile {
   public:
    explicit PartFile(const std::string& file);
    void line(const std::string& text);
    void close();

   private:
    std::string file_;
    std::ofstream out_;
};

}  // namespace slamot::run
