#pragma once
// Logs of actions and sensory frames: pairing, and what time each frame gets.
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <optional>
#include <vector>

#include "ObjectReader.h"

namespace slamot {

/// A movement and what was seen after it; either may be missing.
struct ActionFrame {
    mrpt::obs::CActionCollection::Ptr action;
    mrpt::obs::CSensoryFrame::Ptr observations;
    std::int64_t position = 0;  ///< of the first of the two

    /// Of the first observation that has one, else of the action; none when all are invalid.
    std::optional<Stamp> stamp() const;
};

/// A stamp, unless it is MRPT's 'invalid' or lies outside what MRPT's clock can mean.
std::optional<Stamp> usableStamp(mrpt::Clock::time_point time);

/// Pairs every action with the sensory frame that follows it, as MRPT does.
class FramePairer {
   public:
    /// Takes an action collection or a sensory frame; gives a frame when one is complete.
    std::optional<ActionFrame> add(const LogObject& object);
    /// The action left over at the end of the log.
    std::optional<ActionFrame> flush();

   private:
    std::optional<ActionFrame> pending_;
};

/// Whether the stamps of an action-frame log can be used: all valid, rising, and at least 1 ms a frame on average.
/// Reads the file once from start to end.
bool frameStampsUsable(const std::string& file);

}  // namespace slamot
