// The constants of Adam (Kingma and Ba 2015) for splats.
#pragma once

namespace tureen::trainer {

/// epsilon is that of 3DGS's code: smaller than any gradient that counts.
struct SplatAdam {
  float beta1 = 0.9f, beta2 = 0.999f;
  float epsilon = 1e-15f;
};

}  // namespace tureen::trainer
