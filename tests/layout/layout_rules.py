"""The repository's own rules, checked on its text: what may include what (docs/design.md, section 4), what some
libraries may not use, the length of files, that each source has a test, and that documents lead somewhere.

Every check returns its breaches as lines "path:line: what is wrong". The table of arrows is read from docs/design.md.
"""

import functools
import pathlib
import re
import subprocess
from dataclasses import dataclass

SIDES = ("common", "target", "host")
ROLES = ("include", "src", "testing", "test")
MAX_FILE_LINES = 500


@dataclass(frozen=True)
class Source:
    """A C++ file. `path` is relative to the repository, `library` as in #include <tether/LIBRARY/…> (empty outside of
    the three sides), `role` one of ROLES, "program" (apps) or "other" (tests, bench)."""

    path: str
    text: str

    @functools.cached_property
    def parts(self):
        return self.path.split("/")

    @functools.cached_property
    def role(self):
        if self.parts[0] == "apps":
            return "test" if "test" in self.parts else "program"
        found = [part for part in self.parts if part in ROLES] if self.parts[0] in SIDES else []
        return found[0] if found else "other"

    @functools.cached_property
    def rooms(self):
        """The folders below the side, down to the library's: of the host, the first one is a wing."""
        return self.parts[1 : self.parts.index(self.role)] if self.role in ROLES and self.parts[0] in SIDES else []

    @property
    def library(self):
        in_wing = self.parts[0] == "host" and len(self.rooms) > 1
        return "_".join(self.rooms[1:] if in_wing else self.rooms)

    @property
    def is_product(self):
        return self.role in ("include", "src", "program")

    @property
    def is_header(self):
        return self.path.endswith((".h", ".hpp"))

    @property
    def stem(self):
        return pathlib.PurePath(self.path).stem

    @functools.cached_property
    def includes(self):
        """(line, path, whether it is quoted) of every #include outside of comments."""
        code = blanked(self.text, literals=False)
        return [(code.count("\n", 0, m.start()) + 1, m[2], m[1] == '"')
                for m in re.finditer(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]+)', code, re.M)]


NO_CODE = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?:u8|[uUL])?R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"
      | "(?:\\.|[^"\\\n])*"
      | (?:(?<=\bu8)|(?<![0-9A-Fa-f]))'(?:\\.|[^'\\\n])*'""", re.S | re.X)


def blanked(text, literals=True):
    """The text with comments, and literals if asked, as blanks; line breaks stay."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0]) if literals or match["comment"] else match[0]
    return NO_CODE.sub(blank, text)


def own_library(include):
    """"tether/sim_testing/fake.h" → "sim_testing". The headers that users install have no folder of their own."""
    parts = include.split("/")
    return "" if parts[0] != "tether" else parts[1] if len(parts) > 2 else "client_c_api"


def is_standard(include):
    return include in ("stddef.h", "stdint.h") or not re.search("[./]", include)


def read_arrows(design):
    """({library: libraries that it may include}, {library of the host: its wing}), from the block of folders in
    docs/design.md."""
    arrows, wings, side, wing, library = {}, {}, "", "", ""
    for line in re.search(r"## 4\. Layout.*?```\n(.*?)```", design, re.S)[1].splitlines():
        if top := re.match(r"(\w+)/(\w*)", line):
            side, wing, library = top[1], top[2], ""
        elif side in SIDES:
            if entry := re.match(r"  (\S+)", line):
                library = entry[1].replace("/", "_")
                wings |= {library: wing} if wing else {}
            if (arrow := re.search("→ (.*)", line)) and library:
                arrows[library] = set(arrow[1].replace("/", "_").split()) - {"std"}
    return arrows, wings


def arrows_of_wings(arrows, wings):
    """{wing: other wings that its libraries may include}."""
    return {wing: {wings[to] for library, its in wings.items() if its == wing for to in arrows.get(library, ())
                   if wings.get(to, wing) != wing} for wing in set(wings.values())}


def check_includes(sources, rule):
    return [f"{s.path}:{line}: {wrong}" for s in sources for line, path, quoted in s.includes
            if (wrong := rule(s, path, quoted))]


def check_words(sources, words, why):
    pattern = re.compile(r"\b(" + "|".join(words) + r")\b")
    return [f"{s.path}:{code.count(chr(10), 0, m.start()) + 1}: '{m[0]}': {why}"
            for s in sources for code in [blanked(s.text)] for m in pattern.finditer(code)]


def check_arrows(sources, arrows):
    """Includes between libraries follow the arrows; product code includes no fake."""
    def rule(source, path, _):
        to = own_library(path)
        if source.is_product and (to.endswith("_testing") or "/testing/" in path):
            return f"product code includes the fake <{path}>"
        to = to.removesuffix("_testing")
        if not source.library or not to:
            return None
        if source.library not in arrows:
            return f"library '{source.library}' has no line in docs/design.md, section 4"
        if to != source.library and to not in arrows[source.library]:
            return f"'{source.library}' may not include '{to}' (<{path}>)"
        return None
    return check_includes(sources, rule)


def check_cycles(arrows):
    """No library, or wing, may include itself through others."""
    def reached(room):
        found, new = set(), {room}
        while new:
            new = {to for at in new for to in arrows.get(at, ())} - found
            found |= new
        return found
    return [f"docs/design.md: '{room}' may include itself through others" for room in sorted(arrows)
            if room in reached(room)]


def check_wings(sources, wings):
    """Each library of the host lies in the wing that docs/design.md says."""
    places = {(s.library, s.rooms[0]) for s in sources if s.parts[0] == "host" and s.library}
    return [f"host/{wing}: '{library}' belongs to the wing '{wings.get(library)}' in docs/design.md"
            for library, wing in sorted(places) if wings.get(library) != wing]


def is_own_format(source, path):
    """The room `wire` is templates over FlatBuffers: only sources of other rooms include its writer and reader."""
    return source.library == "wire" and path.startswith("flatbuffers/")


def check_public_headers(sources):
    """They include the standard library and Tether only and quote nothing; every header begins with #pragma once,
    but those that a source includes once for each set of instructions."""
    def rule(source, path, quoted):
        if source.role != "include":
            return None
        if quoted:
            return f'a public header quotes "{path}"; write <tether/...>'
        if not is_standard(path) and not own_library(path) and not is_own_format(source, path):
            return f"a public header includes the third-party <{path}>; keep it in src/"
        return None
    return check_includes(sources, rule) + [
        f"{s.path}:1: no #pragma once on line 1" for s in sources
        if s.is_header and not s.path.endswith("-inl.h") and not s.text.startswith("#pragma once")]


def check_private_headers(sources):
    """A quoted include names a file beside it, or of its library's src/; programs also quote "shared/…", of apps/, and
    benchmarks and tests/ any."""
    paths = {s.path for s in sources}

    def rule(source, path, quoted):
        if source.role == "other" or not quoted or path.endswith("_generated.h"):
            return None
        if ".." in path:
            return f'"{path}" leaves its folder'
        folders = list(pathlib.PurePath(source.path).parents)[:-2]
        if source.parts[0] == "apps" and path.startswith("shared/"):
            folders.append(pathlib.PurePath("apps"))
        if any((folder / sub / path).as_posix() in paths for folder in folders for sub in ("", "src")):
            return None
        return f'"{path}" is no file of this folder'
    return check_includes(sources, rule)


IMPURE_HEADERS = set("""thread mutex shared_mutex condition_variable future semaphore latch barrier stop_token atomic
    fstream iostream ostream istream sstream cstdio filesystem ctime random""".split())
IMPURE_WORDS = """steady_clock system_clock high_resolution_clock clock_gettime sleep_for sleep_until this_thread printf
    fopen socket getenv rand""".split()


def check_sync_is_pure(sources):
    """`sync` has no socket, thread, clock read, sleep, file or log."""
    sync = [s for s in sources if s.library == "sync" and s.is_product]

    def rule(_, path, quoted):
        pure = quoted or own_library(path) or (is_standard(path) and path not in IMPURE_HEADERS)
        return None if pure else f"sync is pure logic; it has no use for <{path}>"
    return check_includes(sync, rule) + check_words(sync, IMPURE_WORDS, "sync is pure logic")


def check_coordinator_is_neutral(sources):
    words = "mujoco Mujoco MuJoCo gazebo Gazebo sim_mujoco sim_gazebo make_mujoco_simulator FaceAnchor RelativePosition tasks vision"
    return check_words([s for s in sources if s.library == "coordinator" and s.is_product], words.split(),
                       "the coordinator names no task and no back end")


def check_randomness(sources):
    """Product code draws random numbers by key; only the link's token comes from the machine."""
    words = "rand srand mt19937 mt19937_64 default_random_engine random_device getrandom getentropy"
    return check_words([s for s in sources if s.is_product and not s.path.startswith("common/link/src/token")],
                       words.split(), "draw by key instead (tether/base/random.h)")


def check_lengths(sources):
    return [f"{s.path}:{MAX_FILE_LINES}: {lines} lines; at most {MAX_FILE_LINES}" for s in sources
            if (lines := len(s.text.splitlines())) > MAX_FILE_LINES]


def check_tests(sources, exceptions):
    """Each source has a test that is named after it (src/x.cpp → test/x[_…]_test.cpp) or includes its header, or is an
    exception; `exceptions` is the text of untested.txt ("path reason" per line)."""
    tested = set()
    for test in (s for s in sources if s.role == "test"):
        tested |= {(test.library, pathlib.PurePath(path).stem) for _, path, _ in test.includes}
        words = test.stem.split("_")
        tested |= {(test.library, "_".join(words[:n])) for n in range(1, len(words))}
    rows = [line.split(maxsplit=1) for line in exceptions.splitlines() if line and not line.startswith("#")]
    untested = {s.path for s in sources if s.role == "src" and not s.is_header and (s.library, s.stem) not in tested}
    named = {row[0] for row in rows}
    return ([f"{path}:1: has no test; add one, or a line with the reason to tests/layout/untested.txt"
             for path in sorted(untested - named)] +
            [f"tests/layout/untested.txt: {path} has a test or is gone" for path in sorted(named - untested)] +
            [f"tests/layout/untested.txt: {row[0]} has no reason" for row in rows if len(row) < 2])


def check_leftovers(texts):
    """`texts`: {path: text} of all files that people read. Also what a merge leaves behind."""
    marks = re.compile(r"\b(TO" + r"DO|FIX" + r"ME|XX" + r"X|HA" + r"CK)\b|^(<{7}|>{7}) .*", re.M)
    return [f"{path}:{text.count(chr(10), 0, m.start()) + 1}: {m[0]}" for path, text in texts.items()
            for m in marks.finditer(text)]


def check_links(texts, exists):
    """Links of Markdown files lead to files; `exists` says whether a path relative to the repository does."""
    breaches = []
    for path, text in texts.items():
        for m in re.finditer(r'\]\(([^)]*)\)|src="([^"]*)"', text) if path.endswith(".md") else ():
            target = m[1] or m[2] or ""
            if not re.match("https?://|mailto:|#", target):
                to = pathlib.PurePath(path).parent / target.split("#")[0]
                breaches += [] if exists(to) else [f"{path}:{text.count(chr(10), 0, m.start()) + 1}: no file {target}"]
    return breaches


def check_decisions(texts):
    """Each ADR has its parts, or names the one that supersedes it, and has a line in the index."""
    parts = ("Status:", "## Context", "## Decision", "## Consequences", "## Alternatives")
    superseded = re.compile(r"^Status: superseded by \[\d{4}\]\(\d{4}-", re.M)
    index = texts.get("docs/adr/README.md", "")
    adrs = {path: text for path, text in texts.items() if re.match(r"docs/adr/\d.*\.md$", path)}
    return ([f"{path}:1: no '{part}'" for path, text in adrs.items() if not superseded.search(text)
             for part in parts if part not in text] +
            [f"{path}:1: not in docs/adr/README.md" for path in adrs if f"({pathlib.PurePath(path).name})" not in index])


def read_repository(root):
    """(sources, texts): the files that people read, sorted by path: tracked and new ones, or all where this is no git
    checkout."""
    git = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                         capture_output=True, text=True)
    if git.returncode == 0:
        paths = git.stdout.strip("\0").split("\0")
    else:
        found = (file.relative_to(root) for file in root.rglob("*"))
        paths = [file.as_posix() for file in found if file.parts[0] != "build" and not file.parts[0].startswith(".")]
    texts = {}
    for path in sorted(paths):
        file = root / path
        if file.is_file() and not file.is_symlink() and "\0" not in (text := file.read_text(errors="replace")):
            texts[path] = text
    tops = ("apps", "bench", *SIDES, "tests")
    return [Source(path, text) for path, text in texts.items()
            if path.split("/")[0] in tops and path.endswith((".h", ".hpp", ".cpp"))], texts
