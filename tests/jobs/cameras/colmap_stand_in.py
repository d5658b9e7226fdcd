#!/usr/bin/env python3
"""Stands in for COLMAP 3.8 in tests: the same commands, output and files, from nothing but names.

Photographs stand on a circle in the order of their names, and share points with their neighbours. The
environment chooses what happens:
  STAND_IN_LOG    file that gets a line with each call
  STAND_IN        words: kill=COMMAND (ends by a signal), fail=COMMAND (exit code 1), slow=COMMAND (waits
                  half a minute in the middle), register=N (cameras for the first N photographs), split
                  (two models), blank (few features), flat (planar pairs, no model), plane (with
                  a model), turning, still
"""
import math
import os
import signal
import sqlite3
import struct
import sys
import time

OPTIONS = dict(word.split("=") if "=" in word else (word, "")
               for word in os.environ.get("STAND_IN", "").split())
command = sys.argv[1]
arguments = dict(zip(sys.argv[2::2], sys.argv[3::2]))
with open(os.environ["STAND_IN_LOG"], "a") as log:
    print(" ".join(sys.argv[1:]), file=log)


def say(text):
    print(text, flush=True)


def middle():
    """What happens to the command when half of it is done."""
    if OPTIONS.get("kill") == command:
        os.kill(os.getpid(), signal.SIGKILL)
    if OPTIONS.get("fail") == command:
        say("ERROR: failed as asked")
        sys.exit(1)
    if OPTIONS.get("slow") == command:
        time.sleep(30)


database = sqlite3.connect(arguments["--database_path"])
database.executescript("""
CREATE TABLE IF NOT EXISTS images (image_id INTEGER PRIMARY KEY, name TEXT UNIQUE, camera_id INTEGER);
CREATE TABLE IF NOT EXISTS keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER);
CREATE TABLE IF NOT EXISTS descriptors (image_id INTEGER PRIMARY KEY, rows INTEGER, data BLOB);
CREATE TABLE IF NOT EXISTS two_view_geometries
  (pair_id INTEGER PRIMARY KEY, rows INTEGER, config INTEGER, H BLOB);
""")


def descriptor(place):
    """One that photographs of the same place share."""
    value = (place + 1) * 2654435761 % 2**32
    data = []
    for _ in range(128):
        value = (value * 1664525 + 1013904223) % 2**32
        data.append(value >> 24)
    return bytes(data)


def extract():
    names = open(arguments["--image_list_path"]).read().split()
    everything = sorted(os.listdir(arguments["--image_path"]))
    known = {name for name, in database.execute("SELECT name FROM images")}
    camera = int(arguments.get("--ImageReader.existing_camera_id", 0))
    if not camera:
        camera = 1 + database.execute("SELECT IFNULL(MAX(camera_id), 0) FROM images").fetchone()[0]
    features = 5 if "blank" in OPTIONS else 300
    for i, name in enumerate(names):
        if i == len(names) // 2:
            middle()
        say(f"Processed file [{i + 1}/{len(names)}]")
        if name in known:
            say("  SKIP: Features for image already extracted.")
            continue
        place = everything.index(name)
        number = database.execute("INSERT INTO images (name, camera_id) VALUES (?, ?)",
                                  (name, camera)).lastrowid
        data = b"".join(descriptor(place + k % 8) for k in range(features))
        database.execute("INSERT INTO keypoints VALUES (?, ?)", (number, features))
        database.execute("INSERT INTO descriptors VALUES (?, ?, ?)", (number, features, data))
        database.commit()


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def homography():
    if "turning" in OPTIONS:  # by a tenth of a radian, with a focal length of 50 pixels
        c, s, f, m = math.cos(0.1), math.sin(0.1), 50.0, 32.0
        lens, undone = [[f, 0, m], [0, f, m], [0, 0, 1]], [[1 / f, 0, -m / f], [0, 1 / f, -m / f], [0, 0, 1]]
        rows = product(product(lens, [[c, 0, s], [0, 1, 0], [-s, 0, c]]), undone)
    else:
        rows = [[1, 0, 0.1 if "still" in OPTIONS else 20], [0, 1, 0], [0, 0, 1]]
    return struct.pack("<9d", *[value for row in rows for value in row])


def match():
    numbers = dict(database.execute("SELECT name, image_id FROM images"))
    lines = open(arguments["--match_list_path"]).read().split("\n")
    print("Matching block [1/1]", end="", flush=True)
    middle()
    flat = any(word in OPTIONS for word in ("flat", "turning", "still", "plane"))
    for line in filter(None, lines):
        a, b = sorted(numbers[name] for name in line.split())
        database.execute("INSERT OR IGNORE INTO two_view_geometries VALUES (?, ?, ?, ?)",
                         (a * 2147483647 + b, 0 if "blank" in OPTIONS else 100, 6 if flat else 3,
                          homography()))
    database.commit()
    say(" in 0.1s")


def write_model(folder, members):
    """Cameras on a circle with radius 4 that look at the origin; `members`: names and image numbers."""
    os.makedirs(folder, exist_ok=True)
    with open(folder + "/cameras.bin", "wb") as file:
        file.write(struct.pack("<QIiQQ8d", 1, 1, 4, 64, 48, 60, 60, 32, 24, 0, 0, 0, 0))
    with open(folder + "/images.bin", "wb") as file:
        file.write(struct.pack("<Q", len(members)))
        for i, (name, number) in enumerate(members):
            half = math.pi * i / len(members)
            file.write(struct.pack("<I7dI", number, math.cos(half), 0, math.sin(half), 0, 0, 0, 4, 1))
            file.write(name.encode() + b"\0" + struct.pack("<Q", 0))
    count = 30 * len(members)
    with open(folder + "/points3D.bin", "wb") as file:
        file.write(struct.pack("<Q", count))
        for i in range(count):
            position = [math.sin(12.9 * i * (k + 1)) for k in range(3)]
            position[2] *= 0.01 if "plane" in OPTIONS else 1
            file.write(struct.pack("<Q3d3BdQ", i + 1, *position, 200, 100, 50, 0.5, 3))
            for k in range(3):
                file.write(struct.pack("<II", members[(i + k) % len(members)][1], i))


def place():
    images = sorted(database.execute("SELECT name, image_id FROM images"))
    say(f"Loading images... {len(images)} in 0.001s (connected {len(images)})")
    if any(word in OPTIONS for word in ("blank", "flat", "turning", "still")):
        say("  => No good initial image pair found.")
        say("ERROR: failed to create sparse model")
        sys.exit(1)
    images = images[:int(OPTIONS.get("register", len(images)))]
    for i, (_, number) in enumerate(images):
        if i == len(images) // 2:
            middle()
        say(f"Registering image #{number} ({i + 1})")
    half = len(images) // 2
    # The smaller one comes first: models are numbered by creation.
    models = [images[half + 1:], images[:half + 1]] if "split" in OPTIONS else [images]
    for i, members in enumerate(models):
        write_model(f"{arguments['--output_path']}/{i}", members)


def triangulate():
    lines = [line.split() for line in open(arguments["--input_path"] + "/images.txt")]
    members = [(words[9], int(words[0])) for words in lines if words]
    middle()
    for _, number in members:
        say(f"Triangulating image #{number}")
    write_model(arguments["--output_path"], members)


{"feature_extractor": extract, "matches_importer": match, "mapper": place,
 "point_triangulator": triangulate}[command]()
say("Elapsed time: 0.001 [minutes]")
