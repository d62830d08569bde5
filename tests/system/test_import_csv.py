"""`import csv`: good tables, and each way they can be broken."""
import unittest

from program import SlamotTest

GOOD = {
    "sensor.ini": "[sensor]\nrange_std = 0.1\nbearing_std_deg = 1\n[vehicle]\nmodel = differential\n",
    "odometry.csv": "t,v,omega\n" + "".join(f"{1000 + 0.1 * k:.1f},1,0\n" for k in range(50)),
    "observations.csv": "t,kind,id,range,bearing\n" +
                        "".join(f"{1000.05 + 0.1 * k:.2f},landmark,3,{10 - 0.1 * k:.2f},0\n" for k in range(40)),
}


class ImportCsv(SlamotTest):
    def data(self, **changes):
        for name, text in GOOD.items():
            self.write("data/" + name, text)
        for name, text in changes.items():
            self.write("data/" + name.replace("__", "."), text)

    def broken(self, says, **changes):
        self.data(**changes)
        self.slamot("import", "csv", "data", "-o", "out.rawlog", code=2, says=says)
        self.assertFalse(self.path("out.rawlog").exists())

    def test_good(self):
        self.data()
        self.slamot("import", "csv", "data", "-o", "out.rawlog")
        self.run_log("out.rawlog")
        self.assertEqual(self.summary()["counts"]["detections"], 40)
        self.assertEqual(self.summary()["counts"]["landmarks"], 1)

    def test_missing(self):
        self.slamot("import", "csv", "none", "-o", "x.rawlog", code=2, says=["none", "no folder"])
        self.slamot("import", "mrclan", "none", "-o", "x.rawlog", code=2, says=["'mrclan'", "did you mean 'mrclam'?"])
        for name in GOOD:
            self.data()
            self.path("data/" + name).unlink()
            self.slamot("import", "csv", "data", "-o", "x.rawlog", code=2, says=[name])
        self.data()
        self.slamot("import", "csv", "data", "-o", "none/x.rawlog", code=2, says=["none/x.rawlog"])

    def test_sensor_ini(self):
        self.broken(["sensor.ini", "range_std"], sensor__ini="[sensor]\nbearing_std_deg = 1\n")
        self.broken(["sensor.ini:2", "above 0"], sensor__ini="[sensor]\nrange_std = 0\nbearing_std_deg = 1\n")
        self.broken(["sensor.ini:4", "[vehicel]", "did you mean 'vehicle'?"],
                    sensor__ini="[sensor]\nrange_std = 1\nbearing_std_deg = 1\n[vehicel]\n")

    def test_odometry(self):
        for text, says in (("", ["odometry.csv:1", "header"]), ("t,a,b\n", ["odometry.csv:1"]),
                           ("t,v,omega\n1,1,0\n2,fast,0\n", ["odometry.csv:3", "'v'", "'fast'", "number"]),
                           ("t,v,omega\n1,1,0\n2,nan,0\n", ["odometry.csv:3", "finite"]),
                           ("t,v,omega\n1,1,0\n2,,0\n", ["odometry.csv:3", "finite"]),
                           ("t,v,omega\n2,1,0\n1,1,0\n", ["odometry.csv:3", "later than the row before"]),
                           ("t,v,omega\n2,1,0\n2,1,0\n", ["odometry.csv:3", "later than the row before"]),
                           ("t,v,omega\nnow,1,0\n", ["odometry.csv:2", "'now'", "decimal seconds"]),
                           ("t,v,omega\n1,1\n2,1,0\n", ["odometry.csv:2", "2 fields", "expected 3"])):
            self.broken(says, odometry__csv=text)

    def test_observations(self):
        head = "t,kind,id,range,bearing\n"
        for text, says in (("t,kind,id,range\n", ["observations.csv:1", "'bearing'"]),
                           (head + "1001,tree,3,1,0\n", ["observations.csv:2", "'tree'", "landmark, mover or unknown"]),
                           (head + "1001,landmark,three,1,0\n", ["observations.csv:2", "'three'", "integer"]),
                           (head + "1001,landmark,-2,1,0\n", ["observations.csv:2", "at least 0"]),
                           (head + "1001,landmark,99999999999,1,0\n", ["99999999999", "too large"]),
                           (head + "1001,landmark,3,near,0\n", ["observations.csv:2", "'near'", "number"])):
            self.broken(says, observations__csv=text)

    def test_nothing_in_it(self):
        self.broken(["no rows"], odometry__csv="t,v,omega\n", observations__csv="t,kind,id,range,bearing\n")

    def test_truth(self):
        self.broken(["robot.csv:2", "finite"], robot__csv="t,x,y,theta\n1000,nan,0,0\n")
        self.path("data/robot.csv").unlink()
        self.broken(["associations.csv", "index 7"],
                    associations__csv="t,index,kind,id\n1000.05,7,landmark,3\n")


if __name__ == "__main__":
    unittest.main()
