// Compares an image with the approved one in tests/golden.
#pragma once

#include <string>

#include "image/image.hpp"

namespace tureen::test {

/// Fails unless `actual` equals tests/golden/NAME.png, up to the differences of llvmpipe between
/// CPU models. As measured, 100 of 307,200 pixels differed, one of them by more than 1/255.
/// The limits are ten times the first and a hundred times the second: 1 pixel in 300 may differ,
/// and 1 in 3,000 by more than a step. A failure writes expected.png, actual.png and difference.png
/// (enlarged) into BUILD/golden/NAME; `./dev golden approve NAME` approves the actual one. A
/// `variant` is another way to draw the same image. It writes into
/// BUILD/golden-variants/NAME-VARIANT, which is never approved.
void expect_golden(const Image8& actual, const std::string& name, const std::string& variant = "");

}  // namespace tureen::test
