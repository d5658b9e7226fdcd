#!/usr/bin/env python3
"""Neural densities against Gaussians with equal bytes and equal processor time: rows for the table
in docs/neural-training.md.

  tests/equal_bytes.py build/release/bin/tureen DATASET --scale 0.5 --bytes 100000 400000

Numbers of steps, from a short calibration, instead of minutes: what else the machine does changes
neither the images nor, much, the processor time. The time of a run includes the Gaussians from
which densities begin, and the reading of photographs and the evaluation, which both methods have.
"""
import argparse
import json
import os
import resource
import subprocess
import tempfile


def run(command):
    """Processor seconds of a program, and the JSON that it prints."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime,
            json.loads(text))


class Runs:
    def __init__(self, options, method, size):
        self.options, self.method, self.size = options, method, size

    def train(self, scene, steps, *more):
        """Processor seconds of a training, and its result."""
        o = self.options
        return run([o.tureen, "train", o.dataset, "-o", scene, "--method", self.method,
                    "--scale", str(o.scale), "--max-bytes", str(self.size), "--steps", str(steps),
                    "--json", *more])

    def step_seconds(self, scene, *more, few=300):
        """Processor seconds of a step, and those of a run without steps."""
        self.train(scene, few, *more)  # the driver keeps the shaders that it compiles here
        (first, _), (second, _) = (self.train(scene, n * few, *more) for n in (1, 2))
        return (second - first) / few, 2 * first - second

    def steps(self, scene):
        """The number of steps that fits in the processor time."""
        each, fixed = self.step_seconds(scene)
        left = 60 * self.options.minutes - fixed
        if self.method != "neural":
            return int(left / each)
        # In short runs, each step also has one of Gaussians.
        start = scene.replace(".glb", "-start.glb")
        os.replace(scene, start)
        own, _ = self.step_seconds(scene, "--init", start)
        gaussian_steps = 4000
        both = min(gaussian_steps, left / each)
        return int(both + max(0, left - both * each) / own)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("tureen")
    parser.add_argument("dataset")
    parser.add_argument("--scale", type=float, default=0.5, help="1, 0.5 or 0.25")
    parser.add_argument("--bytes", type=int, nargs="+", default=[100_000, 400_000, 1_000_000])
    parser.add_argument("--minutes", type=float, default=10, help="processor time of a run")
    parser.add_argument("--seeds", type=int, nargs="+", default=[0])
    parser.add_argument("--methods", nargs="+", default=["gaussians", "neural"])
    parser.add_argument("--folder", help="keeps scenes and logs here")
    o = parser.parse_args()
    folder = o.folder or tempfile.mkdtemp()
    size_name = {1: "full", 0.5: "half", 0.25: "quarter"}[o.scale]
    print("| bytes | method | seed | splats | steps | processor time | PSNR | SSIM | FLIP | ms |")
    print("|---|---|---|---|---|---|---|---|---|---|", flush=True)
    for size in o.bytes:
        for method in o.methods:
            runs = Runs(o, method, size)
            scene = os.path.join(folder, f"{method}-{size}.glb")
            steps = runs.steps(scene)
            for seed in o.seeds:
                scene = os.path.join(folder, f"{method}-{size}-{seed}.glb")
                seconds, result = runs.train(scene, steps, "--seed", str(seed))
                _, bench = run([o.tureen, "bench", scene, o.dataset, "--sizes", size_name,
                                "--blend", "tiles", "--only", "tureen", "--processor-time",
                                "--seconds", "5", "--json"])
                test = result["test"]
                print(f"| {size} | {method} | {seed} | {result['splats']} | {steps} "
                      f"| {seconds:.0f} s | {test['psnr_db']:.2f} | {test['ssim']:.4f} "
                      f"| {test['flip']:.4f} "
                      f"| {bench['measurements'][0]['frame_ms']['median']:.1f} |", flush=True)


if __name__ == "__main__":
    main()
