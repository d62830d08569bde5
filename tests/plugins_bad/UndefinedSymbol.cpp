// A module linked without what it needs: slamot_add_plugin() would not let it be.
#include <slamot/core/plugin/PluginRecord.h>

extern "C" int defined_nowhere();
int used = defined_nowhere();

SLAMOT_PLUGIN_RECORD("undefined", "slamot::Undefined", "estimator", "Needs a symbol that is nowhere");
