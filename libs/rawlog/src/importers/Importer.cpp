#include "slamot/rawlog/Importer.h"

#include "Importers.h"

namespace slamot {

const std::vector<Importer>& importers() {
    static const std::vector<Importer> all = {
        {"mrclam", "UTIAS MRCLAM: Barcodes.dat, Landmark_Groundtruth.dat, Robot<k>_*.dat; one log per robot",
         importMrclam},
        {"csv", "Plain tables: odometry.csv, observations.csv, sensor.ini, optional truth; one log", importCsv},
    };
    return all;
}

}  // namespace slamot
