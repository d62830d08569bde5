// A whole estimator, whose constructor or first step may throw.
#include <mrpt/core/initializer.h>
#include <slamot/core/plugin/Estimator.h>
#include <slamot/core/plugin/PluginRecord.h>

#include <new>
#include <stdexcept>

#include "Words.h"

// MRPT's macros take the class's name as they find it: these put it in before.
#define SLAMOT_DEFINE(NAME_OF_CLASS) DEFINE_MRPT_OBJECT(NAME_OF_CLASS, slamot)
#define SLAMOT_IMPLEMENT(NAME_OF_CLASS) IMPLEMENTS_MRPT_OBJECT(NAME_OF_CLASS, Estimator, slamot)

namespace slamot {

class CLASS : public Estimator {
    SLAMOT_DEFINE(CLASS)

  public:
    CLASS() {
#if defined(THROWS)
        throw std::runtime_error("no licence for this planet");
#elif defined(THROWS_NUMBER)
        throw 42;
#endif
    }
    std::string name() const override {
        return SLAMOT_TEXT(NAME);
    }

  protected:
    std::vector<ParameterTable> onParameters() override {
        return {};
    }
    void onStart(const Start&) override {}
    void onPredict(const OdometryIncrement&) override {
#if defined(OUT_OF_MEMORY)
        throw std::bad_alloc();
#endif
    }
    UpdateReport onUpdate(const DetectionSet&) override {
        return {};
    }
    PoseGaussian onRobot() const override {
        return {};
    }
};

}  // namespace slamot

SLAMOT_IMPLEMENT(CLASS)

SLAMOT_PLUGIN_RECORD(SLAMOT_TEXT(NAME), "slamot::" SLAMOT_TEXT(CLASS), "estimator", "An estimator");

MRPT_INITIALIZER(registerBadPlugin) {
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(CLASS, slamot));
}
