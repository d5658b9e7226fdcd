// Holds an image against the approved one in tests/golden.
#pragma once

#include <string>

#include "image/image.hpp"

namespace tureen::test {

/// Fails unless `actual` is tests/golden/NAME.png up to the differences that llvmpipe shows between
/// CPU models: 100 of 307,200 pixels changed there, one of them by more than 1/255. We allow ten
/// times the first and a hundred times the second: 1 pixel in 300 off at all, 1 in 3,000 by more
/// than a step. A failure leaves expected.png, actual.png and difference.png (enlarged) in
/// BUILD/golden/NAME; `./dev golden approve NAME` takes the actual one over. A `variant`, another
/// way to draw the same image, leaves them in BUILD/golden-variants/NAME-VARIANT: it is never the
/// one to approve.
void expect_golden(const Image8& actual, const std::string& name, const std::string& variant = "");

}  // namespace tureen::test
