#!/usr/bin/env python3
"""Rules of the source tree that no compiler checks. Run by ctest; by hand:

    tests/system/tree_test.py --program build/release/bin/slamot
"""
import argparse
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ""

MAX_LINES = 500
SOURCE_ENDINGS = {".h", ".cpp", ".cc", ".in"}
# What a library may include, besides itself.
MAY_INCLUDE = {
    "core": set(),
    "rawlog": {"core"},
    "sim": {"core", "rawlog"},
    "eval": {"core", "rawlog"},
    "run": {"core", "rawlog", "sim", "eval"},
    "report": {"core", "rawlog", "sim", "eval", "run"},
    "study": {"core", "rawlog", "sim", "eval", "run", "report"},
    "study": {"core", "rawlog", "sim", "eval", "run", "report"},
}
# Estimation itself: Eigen and the standard library only.
WITHOUT_MRPT = ["models", "estimation", "association", "particles", "threads"]
# Folders of one machine. Put together so that this file does not trip over itself.
MACHINE_PATHS = ["/" + "work/", "/" + "tmp/wt", "/" + "home/", "/" + "root/"]


def tracked():
    """Files of the tree, with those not yet committed but without what git ignores."""
    command = ["git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, capture_output=True, text=True)
    if listed.returncode == 0:
        files = [ROOT / line for line in listed.stdout.splitlines()]
    else:  # an unpacked archive
        files = [f for f in ROOT.rglob("*") if "build" not in f.relative_to(ROOT).parts[:1]]
    return sorted(f for f in files if f.is_file())


def plugin_folders():
    return sorted(p for p in (ROOT / "plugins").iterdir() if p.is_dir())


def camel_case(name):
    return "".join(word.capitalize() for word in name.split("_"))


def slamot(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout


def relative(path):
    return str(path.relative_to(ROOT))


class TreeTest(unittest.TestCase):
    maxDiff = None

    def assert_none(self, faults):
        self.assertFalse(faults, "\n" + "\n".join(faults))

    # --- plugins -------------------------------------------------------------------------------------------------

    def test_plugins_are_complete(self):
        self.assertTrue(plugin_folders(), "no plugins found")
        faults = []
        for folder in plugin_folders():
            name = folder.name
            wanted = [folder / "README.md", ROOT / "config" / f"{name}.ini", ROOT / "doc/plugins" / f"{name}.md",
                      folder / f"{camel_case(name)}.h", folder / f"{camel_case(name)}.cpp"]
            faults += [f"{relative(file)} is missing" for file in wanted if not file.is_file()]
            tests = ROOT / "tests/plugins" / name
            sources = "".join(f.read_text() for f in tests.glob("*.cpp"))
            if not sources:
                faults.append(f"{relative(tests)} has no tests")
            elif f"SLAMOT_CONFORMANCE_SUITE({name}," not in sources:
                faults.append(f"{relative(tests)} lacks SLAMOT_CONFORMANCE_SUITE({name}, ...)")
        self.assert_none(faults)

    def test_plugin_names_agree(self):
        listed = {}
        for line in slamot("plugins", "--verbose").splitlines():
            words = line.split()
            if line.startswith(" "):
                listed[name] = words[0]
            else:
                name = words[0]
        faults = []
        for folder in plugin_folders():
            name, text = folder.name, (folder / "CMakeLists.txt").read_text()
            call = re.search(r"slamot_add_plugin\(\s*(\w+)\s+CLASS\s+(\w+)", text)
            if not call or call.groups() != (name, camel_case(name)):
                faults.append(f"{relative(folder)}: expected slamot_add_plugin({name} CLASS {camel_case(name)} ...)")
            if listed.get(name) != f"slamot::{camel_case(name)}":
                faults.append(f"plugin {name}: `slamot plugins` has class {listed.get(name)}")
            if f"add_subdirectory({name})" not in (ROOT / "plugins/CMakeLists.txt").read_text():
                faults.append(f"plugins/CMakeLists.txt lacks {name}")
        self.assert_none(faults)

    def test_configs_are_what_the_program_prints(self):
        for folder in plugin_folders():
            file = ROOT / "config" / f"{folder.name}.ini"
            self.assertEqual(file.read_text(), slamot("config", folder.name),
                             f"{relative(file)} is out of date: slamot config {folder.name} > {relative(file)}")

    def test_doc_pages_have_the_present_parameters(self):
        for folder in plugin_folders():
            page = ROOT / "doc/plugins" / f"{folder.name}.md"
            tables = slamot("config", folder.name, "--markdown")
            self.assertIn(tables, page.read_text(),
                          f"{relative(page)} is out of date: put in what slamot config {folder.name} --markdown prints")

    # --- sources -------------------------------------------------------------------------------------------------

    def test_source_files_are_short(self):
        self.assert_none([f"{relative(f)} has {lines} lines, more than {MAX_LINES}"
                          for f in tracked() if f.suffix in SOURCE_ENDINGS | {".py", ".sh", ".cmake"}
                          for lines in [len(f.read_text().splitlines())] if lines > MAX_LINES])

    def includes_of(self, folder):
        for file in sorted(folder.rglob("*")):
            if file.suffix in SOURCE_ENDINGS:
                for number, line in enumerate(file.read_text().splitlines(), 1):
                    include = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
                    if include:
                        yield f"{relative(file)}:{number}", include.group(1)

    def test_libraries_depend_one_way(self):
        faults = []
        for folder in sorted((ROOT / "libs").iterdir()):
            if not folder.is_dir():
                continue
            library = folder.name
            self.assertIn(library, MAY_INCLUDE, "a new library needs its line in MAY_INCLUDE")
            for place, include in self.includes_of(folder):
                other = re.match(r"slamot/(\w+)/", include)
                if other and other.group(1) not in MAY_INCLUDE[library] | {library}:
                    faults.append(f"{place}: {library} includes {include}")
        for folder in plugin_folders():
            for place, include in self.includes_of(folder):
                if re.match(r"slamot/(?!core/)", include) or include.startswith(".."):
                    faults.append(f"{place}: a plugin includes {include}, which is not of core")
        self.assert_none(faults)

    def test_estimation_does_without_mrpt(self):
        core = ROOT / "libs/core"
        self.assert_none([f"{place} includes {include}"
                          for part in WITHOUT_MRPT
                          for folder in (core / "include/slamot/core" / part, core / "src" / part)
                          for place, include in self.includes_of(folder) if include.startswith("mrpt/")])

    def test_no_paths_of_one_machine(self):
        self.assert_none([f"{relative(file)}:{number} names {path}"
                          for file in tracked()
                          if file.suffix in SOURCE_ENDINGS | {".md", ".sh", ".py", ".ini", ".cmake", ".txt", ".json"}
                          for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1)
                          for path in MACHINE_PATHS if re.search(r"(?<![\w.$}~/])" + re.escape(path), line)])

    # --- the program's surroundings --------------------------------------------------------------------------------

    def test_completion_knows_every_subcommand(self):
        help_text = slamot("--help")
        commands = re.findall(r"^  ([a-z][a-z-]*)\s", help_text[help_text.index("Subcommands:"):], re.MULTILINE)
        self.assertIn("run", commands)
        completion = (ROOT / "apps/slamot/completion/slamot.bash").read_text()
        words = re.search(r'compgen -W "([^"$]*)"', completion).group(1).split()
        self.assert_none([f"completion/slamot.bash lacks {c}" for c in commands if c not in words])

    def test_relative_links_point_somewhere(self):
        faults = []
        for page in (f for f in tracked() if f.suffix == ".md"):
            text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                if re.match(r"[a-z]+:|#", target):
                    continue
                if not (page.parent / target.split("#")[0]).exists():
                    faults.append(f"{relative(page)} links to {target}, which is not there")
        self.assert_none(faults)

    def test_pages_named_in_comments_exist(self):
        self.assert_none([f"{relative(file)} names {page}, which is not there"
                          for file in tracked()
                          if file.suffix in SOURCE_ENDINGS | {".sh", ".py", ".ini", ".cmake", ".txt", ".bash"}
                          for page in re.findall(r"\bdoc/[\w/]+\.md\b", file.read_text(errors="replace"))
                          if not (ROOT / page).exists()])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/slamot"))
    options, rest = parser.parse_known_args()
    PROGRAM = options.program
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
