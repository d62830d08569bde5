#pragma once
// Which object of the joint state each detection of a batch comes from: by the identity the log gives, else
// by association.
#include "slamot/core/association/BatchAssociation.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/estimation/ModalState.h"
#include "slamot/core/filter/ObjectCatalogue.h"

namespace slamot {

/// A batch with what is known of its detections.
struct AssociatedBatch {
    RangeBearingSet seen;                  ///< as handed in
    RangeBearingSet used;                  ///< what to update with: JPDA merges detections of movers
    KnownObjects known;                    ///< in `used`
    std::vector<BlockId> landmarks;        ///< that may be in some sensor's view
    std::vector<int> unexplained;          ///< detections without identity that no object explains
    std::vector<bool> may_be_new;          ///< by number of detection
    std::vector<BlockId> in_doubt;         ///< landmarks whose pairs are undecided
    std::vector<double> likelihood_ratio;  ///< by number of detection: P_D N(nu; 0, S) / c of its pair
};

class ObjectAssociation {
  public:
    ObjectAssociation(const AssociationParameters& parameters, const LifeParameters& landmarks,
                      const LifeParameters& movers, Consistency consistency);

    /// By identity alone; the object and outcome `initiated` of each detection that has one join its
    /// innovation, and those of known objects join `known`.
    static void byIdentity(ObjectCatalogue& objects, const RangeBearingSet& seen,
                           std::vector<Innovation>& innovations, KnownObjects& known);
    /// Whether a detection of this batch could be anything but what its identity says.
    bool concerns(const RangeBearingSet& seen) const;

    /// Both: brings within reach of `belief` what may be seen, and adds to the pairs by identity.
    AssociatedBatch associate(ModalState& belief, ObjectCatalogue& objects, const RangeBearingSet& seen,
                              std::vector<Innovation>& innovations);

  private:
    bool isAssociated(const RangeBearingDetection& detection) const;
    std::vector<BlockId> landmarksInView(const ModalState& belief, const ObjectCatalogue& objects,
                                         const RangeBearingSet& seen) const;
    void pair(ObjectCatalogue& objects, const std::vector<VisibleObject>& visible, AssociatedBatch& batch,
              const BatchAssociation& found, std::vector<Innovation>& innovations) const;

    AssociationParameters parameters_;
    LifeParameters landmark_life_, mover_life_;
    BatchAssociator associator_;
};

}  // namespace slamot
