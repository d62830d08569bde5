#include "slamot/rawlog/Importer.h"

#include "Importers.h"

namespace slamot {

const std::vector<Importer>& importers() {
    static const std::vector<Importer> all = {
        {"mrclam", "UTIAS MRCLAM: Barcodes.dat, Landmark_Groundtruth.dat, Robot<k>_*.dat; one log per robot",
         importMrclam},
        {"victoria-park",
         "Victoria Park: measurements.dat, inputs.dat, gps.dat; optional Sensors_manager.txt and "
         "isam_associations.txt; one log",
         importVictoriaPark},
        {"csv", "Plain tables: odometry.csv, observations.csv, sensor.ini, optional truth; one log",
         importCsv},
    };
    return all;
}

}  // namespace slamot
