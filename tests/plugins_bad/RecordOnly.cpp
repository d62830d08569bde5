// A record with one wrong entry, or all right, and no class behind it.
#include <slamot/core/plugin/PluginRecord.h>

#include "Words.h"

#ifndef MAJOR
#define MAJOR slamot::interface_major
#endif
#ifndef MINOR
#define MINOR slamot::interface_minor
#endif
#ifndef MRPT
#define MRPT MRPT_VERSION
#endif
#ifndef ALIGNMENT
#define ALIGNMENT EIGEN_MAX_ALIGN_BYTES
#endif
#ifndef ABI
#define ABI __GXX_ABI_VERSION
#endif
#ifndef CLASS
#define CLASS NAME
#endif
#ifndef RECORD_NAME
#define RECORD_NAME SLAMOT_TEXT(NAME)
#endif

extern "C" __attribute__((visibility("default")))
const slamot::PluginRecord slamot_plugin_record{MAJOR,
                                                MINOR,
                                                MRPT,
                                                ALIGNMENT,
                                                ABI,
                                                RECORD_NAME,
                                                "slamot::" SLAMOT_TEXT(CLASS),
                                                "estimator",
                                                "Nothing behind it"};
