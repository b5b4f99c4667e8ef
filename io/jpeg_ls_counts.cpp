#include "io/jpeg_ls_counts.hpp"

#include <charls/charls.h>

#include <memory>
#include <new>

#include "io/pixel_claim.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

struct DestroyDecoder {
  void operator()(charls_jpegls_decoder* decoder) const { charls_jpegls_decoder_destroy(decoder); }
};

void require(charls_jpegls_errc result, const std::string& what) {
  if (result != charls::jpegls_errc::success) {
    throw DataError(what + " is a damaged JPEG-LS picture: " + charls_get_error_message(result));
  }
}

}  // namespace

CountsPicture decodeJpegLsCounts(std::span<const std::byte> bytes, const std::string& what) {
  const std::unique_ptr<charls_jpegls_decoder, DestroyDecoder> decoder(charls_jpegls_decoder_create());
  if (!decoder) throw std::bad_alloc();
  require(charls_jpegls_decoder_set_source_buffer(decoder.get(), bytes.data(), bytes.size()), what);
  require(charls_jpegls_decoder_read_header(decoder.get()), what);
  charls_frame_info info{};
  require(charls_jpegls_decoder_get_frame_info(decoder.get(), &info), what);
  if (info.component_count != 1 || info.bits_per_sample < 9 || info.bits_per_sample > 16) {
    throw DataError(what + " is a JPEG-LS picture with " + std::to_string(info.component_count) +
                    " channel(s) of " + std::to_string(info.bits_per_sample) +
                    " bits, expected one channel of 9 to 16 bits");
  }
  checkClaim({info.width, info.height, 2, bytes.size()}, what);
  CountsPicture picture{static_cast<int>(info.width), static_cast<int>(info.height),
                        std::vector<std::uint16_t>(std::size_t{info.width} * info.height)};
  require(charls_jpegls_decoder_decode_to_buffer(decoder.get(), picture.counts.data(),
                                                 picture.counts.size() * sizeof(std::uint16_t), 0),
          what);
  return picture;
}

}  // namespace thermovox
