// A .usda of two prims, as other programs write them.
#pragma once

#include <string>

namespace tureen::test {

/// A splat at (1, 2, 3) under a parent that moves by (10, 0, 0), in a prim that is twice as large,
/// and a disc.
inline const std::string two_fields = R"(#usda 1.0
(
    """A comment of
    two lines."""
    defaultPrim = "World"
    metersPerUnit = 1
    upAxis = "Z"
    customLayerData = { string by = "hand"; dictionary more = { int n = 3 } }
)

def Xform "World" ( prepend references = @other.usda@</A> )
{
    double3 xformOp:translate = (10, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]

    def ParticleField3DGaussianSplat "Splat" (
        kind = "component"
    )
    {
        float3 xformOp:scale = (2, 2, 2)
        uniform token[] xformOpOrder = ["xformOp:scale"]
        float3[] extent = [(-1, -1, -1), (1, 1, 1)]  # skipped
        point3f[] positions = [(1, 2, 3)]
        quatf[] orientations = [(0.5, 0.5, -0.5, 0.5)] (
            interpolation = "vertex"
        )
        float3[] scales = [(0.5, 0.25, 1e-1)]
        float[] opacities = [0.75]
        uniform int radiance:sphericalHarmonicsDegree = 1
        float3[] radiance:sphericalHarmonicsCoefficients = [(1, 2, 3), (4, 5, 6), (7, 8, 9),
            (-1, -2, -3)]
        custom rel material:binding = </World/Look>
        float3[] velocities.timeSamples = { 0: [(1, 2, 3)], 1: None }
    }
    def ParticleField "Disc" (
        prepend apiSchemas = ["ParticleFieldPositionAttributeAPI", "ParticleFieldKernelGaussianSurfletAPI"]
    )
    {
        point3h[] positionsh = [(0, 0, 1)]
        quath[] orientationsh = [(1, 0, 0, 0)]
        half3[] scalesh = [(0.5, 0.25, 0)]
        float3[] radiance:sphericalHarmonicsCoefficients = [(0, 0, 0)]
    }
}
)";

}  // namespace tureen::test
