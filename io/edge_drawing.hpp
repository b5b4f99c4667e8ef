#pragma once

// The adapter between edges and OpenCV: only the sources of pictures include it.

#include <opencv2/core/mat.hpp>

#include "io/visible_edges.hpp"

namespace thermovox {

/// Draws the edges of the visible picture into a thermal one, as light and dark lines (what is left of the
/// brightness without its surroundings). `painted`: 8-bit BGR, the thermal image enlarged `zoom` times. The
/// edges of a picture of little contrast are drawn more strongly, those near the rim of what the visible
/// picture covers not at all.
void drawEdges(cv::Mat& painted, const RegisteredPicture& visible, int zoom);

}  // namespace thermovox
