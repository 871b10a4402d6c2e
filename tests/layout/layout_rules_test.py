"""Plants a breach of each rule; then checks the repository itself.  Run by scripts/test, or:

    python3 -B -m unittest discover -s tests/layout -p '*_test.py'
"""

import pathlib
import re
import subprocess
import unittest

from layout_rules import *

ROOT = pathlib.Path(__file__).resolve().parents[2]
ARROWS = {"base": set(), "uav": {"base"}, "link": {"base", "uav"}, "sim": {"base"}, "sim_mujoco": {"sim"},
          "coordinator": {"sim", "link"}, "client": {"link"}, "client_c_api": {"client"}}


class Text(unittest.TestCase):
    def test_comments_and_literals_become_blanks(self):
        for text, code in {
            "a; // b\nc; /* d\ne */ f;": "a;     \nc;     \n     f;",
            r'''f("a\"{", '{', '\'');''': "f(      ,    ,     );",
            "x = 1'000'000; y = 0xF'F; // z": "x = 1'000'000; y = 0xF'F;     ",
            'x = R"a( " { )" )a"; y': "x =                ; y",
        }.items():
            self.assertEqual(blanked(text), code)

    def test_includes_in_comments_do_not_count(self):
        text = '#include <a/b.h>\n// #include <no.h>\n#  include "c.h"  // why\n/*\n#include <d>\n*/\n'
        self.assertEqual(Source("bench/a.cpp", text).includes, [(1, "a/b.h", False), (3, "c.h", True)])

    def test_a_path_gives_library_and_role(self):
        for path, expected in {
            "host/world/sim/mujoco/src/a/b.cpp": ("sim_mujoco", "src"),
            "host/world/sim/include/tether/sim/world.h": ("sim", "include"),
            "host/report/src/pages/html.cpp": ("report", "src"),
            "common/base/test/time_test.cpp": ("base", "test"),
            "common/base/testing/include/tether/base_testing/c.h": ("base", "testing"),
            "apps/tether/main.cpp": ("", "program"),
            "apps/tether-sut/test/mission_test.cpp": ("", "test"),
            "bench/link_bench.cpp": ("", "other"),
        }.items():
            source = Source(path, "")
            self.assertEqual((source.library, source.role), expected)

    def test_arrows_are_read_from_the_design(self):
        design = "## 4. Layout\n```\napps/\n  x   program\n\ncommon/   both\n  base  words → std\n  c/d   two\n      lines → base sim/sdf\nhost/w/   a wing\n  e/f   room → base\ndata/  → no\n```"
        self.assertEqual(read_arrows(design),
                         ({"base": set(), "c_d": {"base", "sim_sdf"}, "e_f": {"base"}}, {"e_f": "w"}))


class Planted(unittest.TestCase):
    """(path, text, the breach's words; none if it is allowed)"""

    def expect(self, check, *cases):
        for path, text, words in cases:
            breaches = check([Source(path, text)])
            self.assertEqual(len(breaches), 1 if words else 0, (path, text, breaches))
            self.assertIn(words or "", "".join(breaches))

    def test_arrows(self):
        fake = "#include <tether/sim_testing/fake.h>\n"
        self.expect(lambda sources: check_arrows(sources, ARROWS),
                    ("common/uav/src/a.cpp", "\n#include <tether/sim/world.h>\n", "a.cpp:2: 'uav' may not include 'sim'"),
                    ("common/uav/test/a_test.cpp", "#include <tether/link/a.h>\n", "'uav' may not include 'link'"),
                    ("target/client/src/a.cpp", "#include <tether/client.hpp>\n", "may not include 'client_c_api'"),
                    ("host/trial/novel/src/a.cpp", "#include <tether/base/time.h>\n", "has no line"),
                    ("host/flight/coordinator/src/a.cpp", fake, "fake"), ("apps/tether/src/a.cpp", fake, "fake"),
                    ("host/flight/coordinator/test/a_test.cpp", fake, None), ("apps/tether/test/a_test.cpp", fake, None))
        self.assertEqual(check_cycles(ARROWS), [])
        self.assertEqual(len(check_cycles(ARROWS | {"base": {"link"}})), 3)

    def test_wings(self):
        arrows, wings = {"a": {"b", "base"}, "b": {"a"}, "c": {"b"}}, {"a": "low", "b": "low", "c": "high"}
        self.assertEqual(arrows_of_wings(arrows, wings), {"low": set(), "high": {"low"}})
        self.assertEqual(len(check_cycles(arrows_of_wings(arrows | {"b": {"c"}}, wings))), 2)
        self.expect(lambda sources: check_wings(sources, wings), ("host/low/a/src/x.cpp", "", None),
                    ("host/high/a/src/x.cpp", "", "belongs to the wing 'low'"),
                    ("common/base/src/x.cpp", "", None))

    def test_headers(self):
        path = "common/link/include/tether/link/a.h"
        self.expect(check_public_headers,
                    (path, "#pragma once\n#include <fmt/format.h>\n", "third-party"),
                    (path, "#pragma once\n#include <Eigen/Core>\n", "third-party"),
                    (path, '#pragma once\n#include "b.h"\n', "quotes"),
                    (path, "#include <vector>\n", "#pragma once"),
                    ("common/link/src/a.cpp", "#include <fmt/format.h>\n", None))
        header = Source("common/link/src/frame.h", "#pragma once\n")
        quote = '#include "frame.h"\n'
        shared = Source("apps/shared/words.h", "#pragma once\n")
        self.expect(lambda sources: check_private_headers([header, shared, *sources]),
                    ("apps/tether/a.cpp", '#include "shared/words.h"\n', None),
                    ("apps/tether/a.cpp", '#include "shared/others.h"\n', "is no file of this folder"),
                    ("host/flight/sync/src/a.cpp", '#include "shared/words.h"\n', "is no file of this folder"),
                    ("common/link/src/a.cpp", quote + '#include "link_generated.h"\n', None),
                    ("common/link/test/a_test.cpp", quote, None), ("bench/a.cpp", quote, None),
                    ("target/client/src/a.cpp", quote, "is no file of this folder"),
                    ("target/client/src/a.cpp", '#include "../../link/src/frame.h"\n', "leaves its folder"))

    def test_words(self):
        sync = "host/flight/sync/src/a.cpp"
        self.expect(check_sync_is_pure, (sync, "#include <thread>\n", "<thread>"),
                    (sync, "#include <spdlog/spdlog.h>\n", "spdlog"), (sync, "steady_clock::now();\n", "steady_clock"),
                    (sync, "// no steady_clock here\n#include <vector>\n", None))
        self.expect(check_coordinator_is_neutral,
                    ("host/flight/coordinator/src/a.cpp", "\n make_mujoco_simulator();\n", "a.cpp:2"))
        self.expect(check_randomness, ("common/uav/src/a.cpp", "std::mt19937 g;\n", "mt19937"),
                    ("common/uav/test/a_test.cpp", "std::mt19937 g(1);\n", None))

    def test_lengths_and_tests(self):
        self.expect(check_lengths, ("bench/a.cpp", "\n" * 501, "501"), ("bench/a.cpp", "\n" * 500, None))
        source = Source("common/link/src/x_y.cpp", "")
        self.assertEqual(len(check_tests([source], "")), 1)
        self.assertEqual(check_tests([source], "common/link/src/x_y.cpp  y_test\n"), [])
        self.assertEqual(len(check_tests([source], "common/link/src/x_y.cpp\n")), 1)
        for test in ("x_y_test", "x_y_z_test"):
            covered = [source, Source(f"common/link/test/{test}.cpp", "")]
            self.assertEqual(check_tests(covered, ""), [])
            self.assertEqual(len(check_tests(covered, "common/link/src/x_y.cpp  why\n")), 1)

    def test_documents(self):
        self.assertEqual(len(check_leftovers({"a": "\nTO" + "DO: later"})), 1)
        self.assertEqual(len(check_leftovers({"a.md": f"a\n{'<' * 7} HEAD\nb\n{'=' * 7}\nc\n{'>' * 7} f00d (it)\n"})), 2)
        links = {"docs/a.md": "[a](b.md#x) [c](https://d) <img src=\"e.png\">"}
        self.assertEqual(check_links(links, lambda path: path.as_posix() == "docs/b.md"), ["docs/a.md:1: no file e.png"])
        self.assertEqual(len(check_decisions({"docs/adr/0001-a.md": "Status: a ## Context ## Decision ## Consequences"})), 2)
        self.assertEqual(len(check_decisions({"docs/adr/0001-a.md": "Status: superseded by [0002](0002-b.md), because",
                                              "docs/adr/README.md": "[](0001-a.md)"})), 0)
        self.assertEqual(len(check_decisions({"docs/adr/0001-a.md": "Status: superseded",
                                              "docs/adr/README.md": "[](0001-a.md)"})), 4)


class Repository(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sources, cls.texts = read_repository(ROOT)
        cls.arrows, cls.wings = read_arrows(cls.texts["docs/design.md"])

    def test_is_read(self):
        self.assertGreater(sum(s.is_product for s in self.sources), 300)
        self.assertGreater(len(self.arrows), 25)

    def test_keeps_the_rules(self):
        breaches = [*check_arrows(self.sources, self.arrows), *check_cycles(self.arrows),
                    *check_wings(self.sources, self.wings),
                    *check_cycles(arrows_of_wings(self.arrows, self.wings)),
                    *check_public_headers(self.sources), *check_private_headers(self.sources),
                    *check_sync_is_pure(self.sources), *check_coordinator_is_neutral(self.sources),
                    *check_randomness(self.sources), *check_lengths(self.sources),
                    *check_tests(self.sources, self.texts["tests/layout/untested.txt"]),
                    *check_leftovers(self.texts), *check_links(self.texts, lambda path: (ROOT / path).exists()),
                    *check_decisions(self.texts)]
        self.assertFalse(breaches, "\n" + "\n".join(breaches))

    def test_what_stands_in_place_of_the_c_library_is_exported(self):
        exported = set(re.findall(r"(\w+);", (ROOT / "target/as_is/exports.map").read_text()))
        replaced = {name for source in (ROOT / "target/as_is/src").glob("*.cpp")
                    for name in re.findall(r"^TETHER_IN_PLACE [^(;]*?(\w+)\(", source.read_text(), re.M)}
        self.assertGreater(len(replaced), 50)
        self.assertFalse(replaced - exported)

    def test_each_scripts_help_is_its_comment_alone(self):
        scripts = [path for path, text in self.texts.items()
                   if path.startswith("scripts/") and "-h | --help) usage; exit 0 ;;" in text]
        self.assertGreater(len(scripts), 5)
        for script in scripts:
            shown = subprocess.run([ROOT / script, "--help"], capture_output=True, text=True)
            self.assertIn(f"\nusage: {script}", shown.stdout + shown.stderr)
            self.assertNotIn("shellcheck", shown.stdout)


if __name__ == "__main__":
    unittest.main()
