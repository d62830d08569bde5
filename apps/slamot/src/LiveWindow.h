#pragma once
// A 3-D window that follows a run while it goes on.
#include <atomic>
#include <memory>
#include <string>

#include "slamot/run/Sink.h"

namespace slamot::app {

/// Closing the window leaves the run alone. Keys: space pauses and goes on, s takes a single step, + and -
/// change the speed, f follows the robot or not, q closes.
class LiveWindow : public run::Sink {
  public:
    /// `stop`: set by Ctrl-C, ends every waiting. Throws UsageError where there is no display.
    LiveWindow(const std::string& title, const std::atomic<bool>& stop);
    ~LiveWindow() override;
    void step(const run::Step& step) override;
    void end(const run::RunEnd& end) override;
    double heldBack() const override;
    /// Returns once the window is closed or `stop` is set.
    void waitUntilClosed();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace slamot::app
