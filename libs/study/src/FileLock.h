#pragma once
#include <string>

namespace slamot::study {

/// Held by one program at a time; the system lets go of it when the program ends, however it ends.
class FileLock {
  public:
    /// A file, made when it is not there, or a folder that is. Throws LogError.
    explicit FileLock(const std::string& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    int descriptor_;
};

}  // namespace slamot::study
