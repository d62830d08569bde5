#pragma once
#include <chrono>
#include <string>

namespace slamot::app {

/// Progress on stderr: a bar with the time left on a terminal, else a line every few seconds. Silent when quiet.
class Progress {
   public:
    Progress(std::string what, bool quiet);
    ~Progress();
    /// Part done, 0 to 1, and what there is to say beside it. Cheap to call often.
    void show(double done, const std::string& detail = {});

   private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    bool quiet_, terminal_;
    std::size_t drawn_ = 0;  ///< columns
    Clock::time_point begin_, last_;
};

}  // namespace slamot::app
