#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Estimate.h"

namespace slamot {

const char* toText(ObjectKind kind) {
    switch (kind) {
        case ObjectKind::landmark: return "landmark";
        case ObjectKind::mover: return "mover";
        case ObjectKind::unknown: return "unknown";
    }
    return "unknown";
}

const char* toText(Outcome outcome) {
    switch (outcome) {
        case Outcome::updated: return "updated";
        case Outcome::inflated: return "inflated";
        case Outcome::rejected: return "rejected";
        case Outcome::initiated: return "initiated";
        case Outcome::tentative: return "tentative";
        case Outcome::ignored: return "ignored";
    }
    return "ignored";
}

}  // namespace slamot
