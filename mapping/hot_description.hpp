#pragma once

#include "mapping/hot_candidate.hpp"
#include "mapping/hotspot.hpp"

namespace thermovox {

/// The hot spot that a cluster is: by its fit, where this is within what was measured; else by its cells, and
/// its peak is a bound. Errors that all measurements share are not in it.
[[nodiscard]] Hotspot hotspotOf(const HotCandidate& candidate, const SurfaceLayer& layer,
                                const CameraSight& camera);

}  // namespace thermovox
