// What is fuzzed: every reader as a function of bytes. Each target has a source of its own;
// fuzzers, the replay of their corpora and tests/formats/hostile_test.cpp call the same functions.
#pragma once

#include <cstddef>
#include <span>

namespace tureen::fuzz {

using Bytes = std::span<const std::byte>;

// Each reads what the bytes hold, or throws InputError. Anything else is a fault: another
// exception, a scene with a defect, a crash.
void camera_path(Bytes bytes);
void cameras(Bytes bytes);
void checkpoint(Bytes bytes);
void colmap_binary(Bytes bytes);
void colmap_text(Bytes bytes);
void diffsoup(Bytes bytes);
void gltf(Bytes bytes);
void image(Bytes bytes);
void mobilenerf(Bytes bytes);
void obj(Bytes bytes);
void off(Bytes bytes);
void pickle(Bytes bytes);
void ply(Bytes bytes);
void preview(Bytes bytes);
void session(Bytes bytes);
void slim_geometry(Bytes bytes);
void slim_texels(Bytes bytes);
void training_checkpoint(Bytes bytes);
void transforms(Bytes bytes);
void zip(Bytes bytes);

struct Target {
  const char* name;
  void (*read)(Bytes);
};

/// All of them by name.
inline constexpr Target targets[] = {{"camera_path", camera_path},
                                     {"cameras", cameras},
                                     {"checkpoint", checkpoint},
                                     {"colmap_binary", colmap_binary},
                                     {"colmap_text", colmap_text},
                                     {"diffsoup", diffsoup},
                                     {"gltf", gltf},
                                     {"image", image},
                                     {"mobilenerf", mobilenerf},
                                     {"obj", obj},
                                     {"off", off},
                                     {"pickle", pickle},
                                     {"ply", ply},
                                     {"preview", preview},
                                     {"session", session},
                                     {"slim_geometry", slim_geometry},
                                     {"slim_texels", slim_texels},
                                     {"training_checkpoint", training_checkpoint},
                                     {"transforms", transforms},
                                     {"zip", zip}};

}  // namespace tureen::fuzz
