#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The old engine gets its water: samples/old_engine is built as it is and with water.diff, against an installation.

Usage: retrofit.py SOURCE_DIR (--build BUILD_DIR | --root ROOT | --package BUILD_DIR)

--build installs the component "engine" of a build folder into a scratch prefix; --root takes what lies in ROOT. --package makes
the Debian package of a whole build, looks at what is in it, unpacks it and finds Sluice there, without the engine. Runs under an Xvfb of its own (GLX, no graphics card needed), looks at the pixels, and compiles a
program that finds Sluice with CMake. Exit code 77: something that is needed is not installed; the last line says what.
"""
import argparse
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FRAMES = "12"
WIDTH, HEIGHT = 640, 480


def fail(message):
    sys.exit(f"retrofit: {message}")


def need(program, package):
    if shutil.which(program) is None:
        print(f"retrofit: SKIPPED: {program} is missing; apt-get install {package}")
        sys.exit(77)


def run(command, **more):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)
    if done.returncode != 0:
        fail(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done


class Screen:
    """An X server that nobody else uses."""

    def __enter__(self):
        reader, writer = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "1024x768x24", "-nolisten", "tcp", "-noreset"],
                                       pass_fds=[writer], stderr=subprocess.DEVNULL)
        os.close(writer)
        with os.fdopen(reader) as told:
            self.name = ":" + told.readline().strip()
        if self.name == ":":
            fail("Xvfb did not start")
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


def read_ppm(path):
    data = path.read_bytes()
    header = f"P6\n{WIDTH} {HEIGHT}\n255\n".encode()
    if not data.startswith(header) or len(data) != len(header) + WIDTH * HEIGHT * 3:
        fail(f"{path} is no picture of {WIDTH}x{HEIGHT}")
    return data[len(header):]


def differing(a, b):
    """The pixels that differ, as (x, y) from the top left."""
    return [(i % WIDTH, i // WIDTH) for i in range(WIDTH * HEIGHT) if a[3 * i:3 * i + 3] != b[3 * i:3 * i + 3]]


def basin_on_screen():
    """The rectangle that the fluid's box covers: the engine's gluLookAt and gluPerspective."""
    angle, distance = math.radians(20.0), 5.0
    eye = (math.sin(angle) * distance, 2.4, math.cos(angle) * distance)
    forward = [c - e for c, e in zip((0.0, 0.5, 0.0), eye)]
    length = math.sqrt(sum(f * f for f in forward))
    f = [c / length for c in forward]
    s = [-f[2], 0.0, f[0]]
    length = math.hypot(s[0], s[2])
    s = [c / length for c in s]
    u = [s[1] * f[2] - s[2] * f[1], s[2] * f[0] - s[0] * f[2], s[0] * f[1] - s[1] * f[0]]
    focal = HEIGHT / 2 / math.tan(math.radians(25.0))
    xs, ys = [], []
    for corner in ((x, y, z) for x in (-1, 1) for y in (0, 2) for z in (-1, 1)):
        d = [c - e for c, e in zip(corner, eye)]
        depth = sum(a * b for a, b in zip(d, f))
        xs.append(WIDTH / 2 + focal * sum(a * b for a, b in zip(d, s)) / depth)
        ys.append(HEIGHT / 2 - focal * sum(a * b for a, b in zip(d, u)) / depth)
    return min(xs), min(ys), max(xs), max(ys)


def build_engine(source, folder, watered, root):
    folder.mkdir()
    for name in ("old_engine.c", "Makefile", "water.diff"):
        shutil.copy(source / "samples/old_engine" / name, folder)
    command = ["make", "-C", folder]
    if watered:
        run(["patch", "-p1", "--fuzz=0", "-i", "water.diff"], cwd=folder)
        found = dict(os.environ, PKG_CONFIG_PATH=str(root / "lib/pkgconfig"))
        flags = [run(["pkg-config", which, "sluice"], env=found).stdout.strip() for which in ("--cflags", "--libs-only-L")]
        command += [f"CFLAGS=-O1 -Wall -Werror {flags[0]}", f"LDFLAGS={flags[1]}"]
    run(command)
    return folder / "old_engine"


def check_sizes(source):
    lines = (source / "samples/old_engine/old_engine.c").read_text().count("\n")
    diff = (source / "samples/old_engine/water.diff").read_text().splitlines()
    changed = [line for line in diff if line[:1] in "+-" and line[:3] not in ("+++", "---")]
    if lines > 300 or len(changed) >= 30:
        fail(f"the engine has {lines} lines (300 are allowed) and its diff changes {len(changed)} (fewer than 30)")
    return lines, len(changed)


def check_pictures(bare, watered, broken):
    if broken != bare:
        fail(f"with a Sluice that finds no renderer {len(differing(bare, broken))} pixels differ from the bare engine's")
    left, top, right, bottom = basin_on_screen()
    moved = differing(bare, watered)
    stray = [(x, y) for x, y in moved if not (left - 1 <= x <= right + 1 and top - 1 <= y <= bottom + 1)]
    if stray:
        fail(f"{len(stray)} pixels outside of the basin differ, the first at {stray[0]}")
    if len(moved) < 5000:
        fail(f"only {len(moved)} pixels of the basin differ")
    at = [3 * (y * WIDTH + x) for x, y in moved]
    bluer = sum(watered[i + 2] - watered[i] > bare[i + 2] - bare[i] for i in at)
    if bluer < 0.8 * len(at):
        fail(f"of {len(at)} pixels only {bluer} have become bluer: that is no water")
    over = set(moved)
    cross = [(x, y) for x in range(WIDTH // 2 - 10, WIDTH // 2 + 10) for y in range(HEIGHT // 2 - 10, HEIGHT // 2 + 10)
             if bare[3 * (y * WIDTH + x):3 * (y * WIDTH + x) + 2] == bytes((255, 230))]
    if len(cross) < 30 or any(pixel in over for pixel in cross):
        fail(f"the crosshair, {len(cross)} pixels of the bare picture, is not drawn over the water")
    return len(moved)


CONSUMER = """cmake_minimum_required(VERSION 3.25)
project(consumer C)
find_package(Sluice 0.1 REQUIRED)
add_executable(consumer main.c)
set_target_properties(consumer PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)
target_link_libraries(consumer PRIVATE Sluice::sluice)
"""
MAIN = """#include <sluice/sluice.h>
int main(void) { return sluice_api_version() == SLUICE_API_VERSION ? 0 : 1; }
"""


def check_consumer(scratch, root):
    folder = scratch / "consumer"
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(CONSUMER)
    (folder / "main.c").write_text(MAIN)
    run(["cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={root}"])
    run(["cmake", "--build", folder / "build"])
    loads = dict(os.environ, LD_LIBRARY_PATH=str(root / "lib"))
    run([folder / "build/consumer"], env=loads)
    found = dict(os.environ, PKG_CONFIG_PATH=str(root / "lib/pkgconfig"))
    flags = run(["pkg-config", "--cflags", "--libs", "sluice"], env=found).stdout.split()
    run(["cc", "-std=c99", "-pedantic-errors", folder / "main.c", "-o", folder / "by-hand", *flags])
    run([folder / "by-hand"], env=loads)


MANUAL = """#include <sluice/sluice.h>
static void draw_world(void) {}
static void draw_hud(void) {}
static void draw_crate(const float *centre, const float *turn) { (void)centre; (void)turn; }
int main(void) {
    const float view[16] = { 0 }, projection[16] = { 0 };
    const double seconds = 0.0;
%s
    return 0;
}
"""


def check_manual(source, scratch, root):
    """What docs/retrofit.md shows of C compiles as it stands there, one block after the other."""
    blocks = re.findall(r"```c\n(.*?)```", (source / "docs/retrofit.md").read_text(), re.DOTALL)
    if len(blocks) < 4 or "SluiceEmitter" not in "".join(blocks):
        fail(f"docs/retrofit.md has {len(blocks)} blocks of C, and those with emitter, solid and body are not among them")
    (scratch / "manual.c").write_text(MANUAL % "\n".join(blocks))
    run(["cc", "-std=c99", "-pedantic-errors", "-Wall", "-Werror", "-fsyntax-only", f"-I{root}/include", scratch / "manual.c"])


PACKAGED = ("bin/sluice", "bin/sluice-renderer", "lib/libsluice.so", "lib/libsluice.so.1", "lib/libsluice.so.1.0",
            "lib/sluice/libsluice_renderer_vk.so", "include/sluice/sluice.h", "include/sluice/plugin.h",
            "include/sluice/sluice_trace.h", "lib/pkgconfig/sluice.pc", "lib/cmake/Sluice/SluiceConfig.cmake")


def check_package(build):
    need("dpkg-shlibdeps", "dpkg-dev")
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        run(["cpack", "--config", build / "CPackConfig.cmake", "-G", "DEB", "-B", scratch / "made"])
        packages = sorted((scratch / "made").glob("*.deb"))
        if len(packages) != 1:
            fail(f"cpack made {len(packages)} packages")
        listed = run(["dpkg-deb", "-c", packages[0]]).stdout
        lacking = [path for path in PACKAGED if f"./usr/{path}" not in listed]
        if lacking:
            fail(f"{packages[0].name} lacks {', '.join(lacking)}")
        depends = run(["dpkg-deb", "-f", packages[0], "Depends"]).stdout
        absent = [library for library in ("libepoxy0", "libvulkan1", "libc6") if library not in depends]
        if absent:
            fail(f"{packages[0].name} depends on {depends.strip()}, not on {', '.join(absent)}")
        run(["dpkg-deb", "-x", packages[0], scratch / "root"])
        check_consumer(scratch, scratch / "root/usr")
        print(f"retrofit: {packages[0].name}, {packages[0].stat().st_size} bytes, holds what an engine needs")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("source", type=pathlib.Path)
    options.add_argument("--build", type=pathlib.Path)
    options.add_argument("--root", type=pathlib.Path)
    options.add_argument("--package", type=pathlib.Path)
    options.add_argument("--keep", type=pathlib.Path, help="write the two pictures there")
    asked = options.parse_args()
    if asked.package:
        check_package(asked.package.resolve())
        return
    need("Xvfb", "xvfb")
    need("patch", "patch")
    need("make", "make")
    if not pathlib.Path("/usr/include/GL/glut.h").exists():
        print("retrofit: SKIPPED: GL/glut.h is missing; apt-get install libglut-dev")
        sys.exit(77)
    lines, changed = check_sizes(asked.source)
    with tempfile.TemporaryDirectory() as name, Screen() as screen:
        scratch = pathlib.Path(name)
        root = asked.root
        if root is None:
            root = scratch / "root"
            run(["cmake", "--install", asked.build, "--component", "engine", "--prefix", root])
        engines = {kind: build_engine(asked.source, scratch / kind, kind == "watered", root) for kind in ("bare", "watered")}
        environment = dict(os.environ, DISPLAY=screen.name, LD_LIBRARY_PATH=str(root / "lib"))
        environment.pop("SLUICE_PLUGIN", None)
        pictures = {}
        for kind, engine, more in (("bare", "bare", {}), ("watered", "watered", {}),
                                   ("broken", "watered", {"SLUICE_PLUGIN": "/nowhere/at/all.so"})):
            shot = scratch / f"{kind}.ppm"
            done = run([engines[engine], "-frames", FRAMES, "-shot", shot], env=dict(environment, **more), timeout=200)
            pictures[kind] = read_ppm(shot)
            told = done.stderr.splitlines()
            if kind == "broken" and (len(told) != 1 or "/nowhere/at/all.so" not in told[0]):
                fail(f"expected one line that names the plugin, found: {told}")
            if kind != "broken" and told:
                fail(f"{kind}: unexpected on stderr: {told}")
            if asked.keep:
                shutil.copy(shot, asked.keep)
        pixels = check_pictures(pictures["bare"], pictures["watered"], pictures["broken"])
        check_consumer(scratch, root)
        check_manual(asked.source, scratch, root)
    print(f"retrofit: {lines} lines of engine, {changed} changed: {pixels} pixels of water, all others as they were")


if __name__ == "__main__":
    main()
