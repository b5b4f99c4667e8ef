#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace thermovox {

/// What a JPEG-LS scan of one channel is coded with (ITU-T T.87, C.2.4.1.1).
struct JpegLsCoding {
  int max_value = 65535;  ///< of a sample
  int near = 0;           ///< how far a sample may be off; FLIR's recordings are not always exact
  int t1 = 0, t2 = 0, t3 = 0;
  int reset = 64;
};

/// The coding that holds where a picture does not say another.
[[nodiscard]] JpegLsCoding usualJpegLsCoding(int max_value, int near);

/// Decodes the bytes of a scan into `samples`, row by row of `width`, whose number says how many rows there
/// are. `what` comes first in messages. Throws DataError when the bytes end before the picture does, or say
/// what no encoder writes.
void decodeJpegLsScan(std::span<const std::byte> bytes, const JpegLsCoding& coding, std::size_t width,
                      std::span<std::uint16_t> samples, const std::string& what);

}  // namespace thermovox
