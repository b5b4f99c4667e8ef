#pragma once

namespace thermovox {

/// Up to this angle from its normal a surface radiates like before it, within 2 %: radians (50 degrees).
inline constexpr double kSteepestPlainView = 0.8726646259971648;

/// How much less a surface radiates towards a camera that sees it at a grazing angle than towards one at
/// kSteepestPlainView, as a share: 1 - e(angle) / e(50 degrees), 0 to 1, with `cosine` of the angle between
/// the line of sight and the surface's normal; 0 before that. A smooth dielectric of refractive index 1.5
/// (paint, plastic, brick, oxidised metal; see Howell, Menguc and Siegel, Thermal Radiation Heat Transfer,
/// chapter 3): e = 1 - r by Kirchhoff's law, r by Fresnel's equations without polarisation. 1 % at 55
/// degrees, 3 % at 60, 12 % at 70, 35 % at 80.
[[nodiscard]] float emissivityLoss(float cosine);

}  // namespace thermovox
