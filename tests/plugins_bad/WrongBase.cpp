// Says it is an estimator and registers an object of another kind.
#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <slamot/core/plugin/PluginRecord.h>

namespace slamot {

class WrongBase : public mrpt::rtti::CObject {
    DEFINE_MRPT_OBJECT(WrongBase, slamot)
};

}  // namespace slamot

IMPLEMENTS_MRPT_OBJECT(WrongBase, mrpt::rtti::CObject, slamot)

SLAMOT_PLUGIN_RECORD("wrong_base", "slamot::WrongBase", "estimator", "No estimator");

MRPT_INITIALIZER(registerBadPlugin) {
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(WrongBase, slamot));
}
