// glTF's numbers of component types (glTF 2.0, section 3.6.2.2).
#pragma once

namespace tureen::glb_layout {

inline constexpr int unsigned_byte = 5121;
inline constexpr int unsigned_short = 5123;
inline constexpr int unsigned_int = 5125;
inline constexpr int float32 = 5126;

}  // namespace tureen::glb_layout
