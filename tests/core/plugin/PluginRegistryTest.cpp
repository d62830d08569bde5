#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "slamot/core/plugin/PluginRegistry.h"
#include "support/Expect.h"

namespace slamot {
namespace plugin_registry_test {

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string real_plugins = SLAMOT_BINARY_DIR "/lib/slamot/plugins";

std::string badFolder(const std::string& folder) {
    return std::string(SLAMOT_BAD_PLUGINS) + "/" + folder;
}

std::string badFile(const std::string& name) {
    return badFolder(name) + "/libslamot_" + name + ".so";
}

/// The sentence with which a module is refused; it begins with the file and is one line.
std::string refusal(const std::string& file) {
    const std::string message = messageOf<PluginError>([&] { probePlugin(file); });
    EXPECT_THAT(message, StartsWith(file + ": "));
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
}

TEST(PluginRegistryTest, FindsTheRealPlugins) {
    const auto registry = PluginRegistry::discover({real_plugins});
    const PluginInfo& info = registry.find("dead_reckoning", "estimator");
    EXPECT_EQ(info.class_name, "slamot::DeadReckoning");
    EXPECT_EQ(info.kind, "estimator");
    EXPECT_FALSE(info.about.empty());
    EXPECT_EQ(info.file, real_plugins + "/libslamot_dead_reckoning.so");
    EXPECT_TRUE(std::is_sorted(registry.plugins().begin(), registry.plugins().end(),
                               [](const PluginInfo& a, const PluginInfo& b) { return a.name < b.name; }));
    EXPECT_EQ(registry.createEstimator("dead_reckoning")->name(), "dead_reckoning");
    // Each creation is a new object, of a module that is loaded once.
    EXPECT_NE(registry.createEstimator("ekf_slamot"), registry.createEstimator("ekf_slamot"));
}

TEST(PluginRegistryTest, UnknownNamesGetTheNearestAndTheList) {
    const auto registry = PluginRegistry::discover({real_plugins});
    EXPECT_THAT(messageOf<PluginError>([&] { registry.createEstimator("ekf_slamod"); }),
                AllOf(HasSubstr("no estimator 'ekf_slamod'"), HasSubstr("did you mean 'ekf_slamot'?"),
                      HasSubstr("dead_reckoning")));
    EXPECT_THAT(messageOf<PluginError>([&] { registry.find("ekf_slamot", "detector"); }),
                HasSubstr("no detector 'ekf_slamot'"));
    EXPECT_THAT(messageOf<PluginError>([&] { PluginRegistry::discover({}).find("x", "estimator"); }),
                HasSubstr("there are none"));
}

TEST(PluginRegistryTest, RefusesWhatIsNoModule) {
    EXPECT_THAT(refusal("/nowhere/libslamot_x.so"), HasSubstr("no such plugin file"));
    EXPECT_THAT(refusal(badFolder("text")), HasSubstr("no such plugin file"));  // a folder
    EXPECT_THAT(refusal(badFile("text")), HasSubstr("cannot be loaded"));
    EXPECT_THAT(refusal(badFile("no_record")),
                HasSubstr("is no slamot plugin: symbol 'slamot_plugin_record' is missing"));
    EXPECT_THAT(refusal(badFile("undefined")),
                AllOf(HasSubstr("cannot be loaded"), HasSubstr("defined_nowhere")));
}

TEST(PluginRegistryTest, RefusesModulesOfAnotherBuild) {
    EXPECT_THAT(refusal(badFile("other_major")),
                HasSubstr("was built for plugin interface 1.1, this program has 0.1"));
    EXPECT_THAT(refusal(badFile("higher_minor")),
                HasSubstr("was built for plugin interface 0.2, this program has 0.1"));
    EXPECT_EQ(probePlugin(badFile("lower_minor")).name, "lower_minor");  // what it needs is still there
    EXPECT_THAT(refusal(badFile("other_mrpt")),
                HasSubstr("was built with MRPT 0x10203, this program with 0x"));
    EXPECT_THAT(refusal(badFile("other_alignment")), HasSubstr("was built with Eigen alignment 0x40"));
    EXPECT_THAT(refusal(badFile("other_abi")), HasSubstr("was built with compiler ABI 0x7"));
}

TEST(PluginRegistryTest, SurvivesStartUpCode) {
    for (const char* name : {"aborts", "throws", "exits"})
        EXPECT_THAT(refusal(badFile(name)), HasSubstr("crashed while being loaded")) << name;
}

TEST(PluginRegistryTest, StartUpCodePrintsNowhere) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const PluginInfo info = probePlugin(badFile("prints"));
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(info.name, "prints");
}

TEST(PluginRegistryTest, FailuresAtCreationNameTheFile) {
    const auto creating = [](const std::string& name) {
        const auto registry = PluginRegistry::discover({badFolder(name)});
        EXPECT_TRUE(registry.refused().empty());
        const std::string message = messageOf<PluginError>([&] { registry.createEstimator(name); });
        EXPECT_THAT(message, StartsWith(badFile(name) + ": "));
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    };
    EXPECT_THAT(
        creating("throwing_constructor"),
        HasSubstr("the constructor of slamot::ThrowingConstructor failed: no licence for this planet"));
    EXPECT_THAT(creating("throwing_number"), HasSubstr("the constructor of slamot::ThrowingNumber failed"));
    EXPECT_THAT(creating("wrong_base"), HasSubstr("slamot::WrongBase is no estimator, as its record says"));
    EXPECT_THAT(creating("unregistered"),
                HasSubstr("says it has class slamot::unregistered, which it does not register"));
}

TEST(PluginRegistryTest, RefusesBothOfADouble) {
    for (const auto& [folder, what] : {std::pair{"same_class", "class slamot::Twin is also that of "},
                                       std::pair{"same_name", "name 'twin' is also that of "}}) {
        const auto registry = PluginRegistry::discover({badFolder(folder)});
        EXPECT_TRUE(registry.plugins().empty());
        ASSERT_EQ(registry.refused().size(), 2u);
        for (int i = 0; i < 2; ++i)
            EXPECT_EQ(registry.refused()[i].reason,
                      registry.refused()[i].file + ": " + what + registry.refused()[1 - i].file);
    }
    // Asking for one of them by its file's name says why it is not there.
    const auto registry = PluginRegistry::discover({badFolder("same_class")});
    EXPECT_THAT(messageOf<PluginError>([&] { registry.createEstimator("twin_a"); }),
                AllOf(StartsWith("estimator 'twin_a' was refused: "), HasSubstr("libslamot_twin_b.so")));
}

TEST(PluginRegistryTest, ARefusedModuleDoesNotKeepOthersAway) {
    const auto registry = PluginRegistry::discover({badFolder("aborts"), badFolder("text"), real_plugins});
    EXPECT_EQ(registry.refused().size(), 2u);
    EXPECT_NO_THROW(registry.find("ekf_slamot", "estimator"));
    const std::string message = messageOf<PluginError>([&] { registry.find("aborts", "estimator"); });
    EXPECT_EQ(message,
              "estimator 'aborts' was refused: " + badFile("aborts") + ": crashed while being loaded");
}

TEST(PluginRegistryTest, EarlierFoldersHideNames) {
    const auto classOf = [](const std::vector<std::string>& folders) {
        return PluginRegistry::discover(folders).find("shared_name", "estimator").class_name;
    };
    EXPECT_EQ(classOf({badFolder("early"), badFolder("late")}), "slamot::Early");
    EXPECT_EQ(classOf({badFolder("late"), badFolder("early")}), "slamot::Late");
    const auto both = PluginRegistry::discover({badFolder("early"), badFolder("late")});
    EXPECT_EQ(both.plugins().size(), 2u);
    EXPECT_TRUE(both.refused().empty());
    EXPECT_NO_THROW(both.find("only_late", "estimator"));
}

TEST(PluginRegistryTest, SearchPathHasSeveralEntriesAndEmptyParts) {
    const std::string path = "::" + badFolder("early") + "::/nowhere:" + badFolder("late") + ":";
    ASSERT_EQ(setenv("SLAMOT_PLUGIN_PATH", path.c_str(), 1), 0);
    EXPECT_EQ(PluginRegistry::defaultFolders(),
              (std::vector<std::string>{badFolder("early"), "/nowhere", badFolder("late"), real_plugins}));
    const auto registry = PluginRegistry::discover();
    unsetenv("SLAMOT_PLUGIN_PATH");
    EXPECT_EQ(registry.find("shared_name", "estimator").class_name, "slamot::Early");
    EXPECT_NO_THROW(registry.find("only_late", "estimator"));
    EXPECT_NO_THROW(registry.find("ekf_slamot", "estimator"));
    EXPECT_EQ(PluginRegistry::defaultFolders(), std::vector<std::string>{real_plugins});
}

}  // namespace plugin_registry_test
}  // namespace slamot
