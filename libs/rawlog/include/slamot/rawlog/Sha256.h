#pragma once
#include <cstddef>
#include <memory>
#include <string>

namespace slamot {

/// SHA-256, piece by piece.
class Sha256 {
   public:
    Sha256();
    ~Sha256();
    void add(const void* data, std::size_t bytes);
    /// In hex, of all that was added; once.
    std::string hex();

   private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace slamot
