"""Writes the checkpoints in this folder as the authors' programs do: with torch.save, the same keys, and
parameters on a GPU. tests/formats/checkpoint_test.cpp states the values again.

    python3 write_checkpoints.py    (torch 1.13.0, Debian's python3-torch)
"""
import math
import pathlib

import torch

# Published files have tensors of a GPU; the tag is all that a file shows of it.
torch.serialization.register_package(0, lambda storage: "cuda:0", lambda storage, location: storage)


def parameter(shape, start, step):
    """Number i is start + step * (89 i^2 mod 257), which float stores exactly."""
    scattered = 89 * torch.arange(math.prod(shape)) ** 2 % 257
    return torch.nn.Parameter((start + step * scattered.float()).reshape(shape))


def ramp(count, start, step):
    return torch.nn.Parameter(start + step * torch.arange(count).float().reshape(count, 1))


def triangle_splatting(triangles):
    """arXiv 2505.19175, scene/triangle_model.py, save_parameters()."""
    return {
        "triangles_points": parameter((triangles, 3, 3), -2, 1 / 64),
        "sigma": ramp(triangles, -3, 0.5),
        "active_sh_degree": 3,
        "features_dc": parameter((triangles, 1, 3), -1, 1 / 128),
        "features_rest": parameter((triangles, 15, 3), -1 / 8, 1 / 1024),
        "opacity": ramp(triangles, -4, 1.5),
    }


def connected(vertices, triangles, degree):
    """arXiv 2509.25122 and 2512.06818, scene/triangle_model.py, save_parameters()."""
    return {
        "triangles_points": parameter((vertices, 3), -2, 1 / 64),
        "_triangle_indices": torch.tensor(triangles, dtype=torch.int32),
        "vertex_weight": ramp(vertices, 2, -1),
        "sigma": math.log(1e-4),
        "active_sh_degree": degree,
        "features_dc": parameter((vertices, 1, 3), -1, 1 / 128),
        "features_rest": parameter((vertices, 15, 3), -1 / 8, 1 / 1024),
        "importance_score": torch.ones(len(triangles)),
        "image_size": torch.zeros(len(triangles)),
    }


folder = pathlib.Path(__file__).parent
torch.save(triangle_splatting(6), folder / "triangle_splatting.pt")
faces = [[0, 1, 2], [2, 1, 3], [3, 4, 2]]
torch.save(connected(5, faces, 3), folder / "triangle_splatting_plus.pt")
mesh = connected(5, faces, 2)
mesh["pixel_count"] = torch.zeros(len(faces), dtype=torch.int32)
torch.save(mesh, folder / "mesh_splatting.pt")
