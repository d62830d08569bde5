#pragma once
// The modes a mover may be in, and how it changes between them: a Markov chain (paper 1, section 2.3).
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/models/TargetMotion.h"

namespace slamot {

struct TargetMode {
    /// Heads its probability's column in tracks.csv: letters, digits and _.
    std::string name;
    TargetModel model;
};

/// Transition probabilities p_ij: row i holds where a mover in mode i goes.
class ModeChain {
  public:
    /// One mode, which a mover never leaves.
    ModeChain() : p_(Eigen::MatrixXd::Ones(1, 1)) {}
    /// `p` holds over `interval` [s]; 0: over a prediction, whatever its length. Throws std::invalid_argument
    /// with one sentence when rows do not sum to 1, or when no chain in continuous time has p after
    /// `interval`.
    ModeChain(const Eigen::MatrixXd& p, double interval);

    int modes() const { return static_cast<int>(p_.rows()); }
    /// p_ij of a prediction over dt [s]: p^(dt / interval).
    Eigen::MatrixXd over(double dt) const;

  private:
    Eigen::MatrixXd p_;
    /// d p / dt at 0, log(p) / interval; empty where p holds for each prediction.
    Eigen::MatrixXd generator_;
};

/// Which density of a mover's innovation makes its modes likely.
enum class ModeLikelihood {
    conditional,  ///< given the landmarks' innovations of the same batch
    marginal      ///< alone, as paper 1 prints it
};

/// How the modes of several movers are kept.
enum class ImmForm {
    automatic,  ///< exact while there are few movers, else scalable
    exact,      ///< one joint Gaussian for each combination of modes
    scalable,   ///< one joint Gaussian, and beside it a bank of modes for each mover
    decoupled   ///< a baseline: an IMM for each mover that nothing couples with robot and map
};

struct ImmParameters {
    /// None: all movers follow the filter's one target model, an EKF.
    std::vector<TargetMode> modes;
    double noise_interval = 0.1;  ///< [s], TargetModel's, for all modes
    /// p_ii; the rest is shared evenly.
    double stay_probability = 0.97;
    /// All p_ij, row by row, instead of stay_probability.
    std::optional<std::vector<double>> transition;
    double transition_interval = 0.15;  ///< [s]; 0: per prediction
    /// Mode probabilities at first sight; none: all equal.
    std::optional<std::vector<double>> initial;

    ModeLikelihood likelihood = ModeLikelihood::conditional;
    ImmForm form = ImmForm::automatic;
    int max_exact_targets = 2;
};

/// Throw std::invalid_argument with one sentence when the numbers do not fit the modes.
ModeChain chainOf(const ImmParameters& parameters);
Eigen::VectorXd initialProbabilities(const ImmParameters& parameters);
std::vector<TargetModel> modelsOf(const ImmParameters& parameters);

/// Of movers that have no modes, since they are not confirmed yet, or lost. Whatever the order of the models.
const TargetModel& simplestOf(const std::vector<TargetModel>& models);

/// Adds the keys of the modes and of their chain.
void describe(ImmParameters& parameters, ParameterTable& table);

}  // namespace slamot
