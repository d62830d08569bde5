#include "conformance/Conformance.h"

#include <fstream>
#include <iostream>
#include <iterator>

#include "conformance/Laws.h"

namespace slamot::conformance {
namespace {

#ifdef SLAMOT_DOC_FOLDER
/// Text with runs of white space as one space: an exemption may be wrapped over lines.
std::string unwrapped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (!space) out += c;
        if (space && !out.empty() && out.back() != ' ') out += ' ';
    }
    return out;
}
#endif

/// An exemption that users cannot read is none.
void expectDocumented(const Options& options) {
#ifdef SLAMOT_DOC_FOLDER
    const std::string page = std::string(SLAMOT_DOC_FOLDER) + "/" + options.plugin + ".md";
    std::ifstream file(page);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    EXPECT_NE(unwrapped(text).find(options.nees_exemption), std::string::npos)
        << page << " does not say why NEES is exempt: '" << options.nees_exemption << "'";
#else
    std::cout << options.plugin << " is exempt from the NEES law: " << options.nees_exemption << "\n";
#endif
}

}  // namespace

Options named(const std::string& suite, Options options) {
    if (options.plugin.empty()) options.plugin = suite;
    return options;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Conformance);

#define SLAMOT_LAW(NAME, LAW)                  \
    TEST_P(Conformance, NAME) {                \
        EXPECT_EQ(LAW(GetParam()), Verdict()); \
    }

SLAMOT_LAW(SameBitsForAnyThreads, sameBitsForAnyThreads)
SLAMOT_LAW(ResetEqualsNew, resetEqualsNew)
SLAMOT_LAW(CovariancesStayDefinite, covariancesStayDefinite)
SLAMOT_LAW(EmptySetIsAccepted, emptySetIsAccepted)
SLAMOT_LAW(TimeGoingBackIsRefused, timeGoingBackIsRefused)
SLAMOT_LAW(QueriesAgree, queriesAgree)
SLAMOT_LAW(ParametersRoundTrip, parametersRoundTrip)
SLAMOT_LAW(UnknownKeyIsRefused, unknownKeyIsRefused)
SLAMOT_LAW(WorldMayBeMoved, worldMayBeMoved)
SLAMOT_LAW(BearingsAcrossPi, bearingsAcrossPi)
SLAMOT_LAW(NoiseFreeConverges, noiseFreeConverges)
SLAMOT_LAW(CrowdIsSurvived, crowdIsSurvived)

TEST_P(Conformance, NeesInBand) {
    const Verdict verdict = neesInBand(GetParam());
    if (GetParam().nees_exemption.empty()) {
        EXPECT_EQ(verdict, Verdict());
        return;
    }
    EXPECT_NE(verdict, Verdict()) << "the law holds: the exemption can go";
    expectDocumented(GetParam());
}

}  // namespace slamot::conformance
