#pragma once
// What a plugin module says about itself before any of its code runs. `slamot_add_plugin()` writes the record;
// the registry reads it in a child process and refuses modules that could not work here.
#include <Eigen/Core>

#include <mrpt/version.h>

namespace slamot {

/// Version of the Estimator and Detector interfaces. A module fits when the major is equal and its minor is not
/// above the program's.
inline constexpr int interface_major = 0;
inline constexpr int interface_minor = 1;

/// Plain data, so that a reader of another build understands it.
struct PluginRecord {
    int interface_major, interface_minor;
    int mrpt_version;            ///< MRPT_VERSION
    int eigen_max_align_bytes;   ///< must agree, or vectors passed across the border are misaligned
    int compiler_abi;            ///< __GXX_ABI_VERSION
    const char* name;            ///< plugin name: its section in configs
    const char* class_name;      ///< registered class, with namespace
    const char* kind;            ///< "estimator" or "detector"
    const char* about;           ///< one line
};

inline constexpr const char* plugin_record_symbol = "slamot_plugin_record";

}  // namespace slamot

/// Used once, in the source that slamot_add_plugin() generates.
#define SLAMOT_PLUGIN_RECORD(NAME, CLASS, KIND, ABOUT)                                                          \
    extern "C" __attribute__((visibility("default"))) const slamot::PluginRecord slamot_plugin_record{          \
        slamot::interface_major, slamot::interface_minor, MRPT_VERSION, EIGEN_MAX_ALIGN_BYTES, __GXX_ABI_VERSION, \
        NAME, CLASS, KIND, ABOUT}
