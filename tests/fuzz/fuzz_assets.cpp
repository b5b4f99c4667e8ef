#include "io/asset_file.hpp"
#include "tests/fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace thermovox;
  fuzz::read([&] {
    const Assets assets = parseAssets(fuzz::textOf(data, size), "fuzz.yaml");
    fuzz::require(assets.size() > 0);
    for (std::size_t i = 0; i < assets.size(); ++i) {
      const Eigen::Vector3d& middle = assets[i].T_world_box.translation;
      fuzz::require(assets[i].holds(middle));
      const std::optional<std::size_t> at = assets.at(middle);
      fuzz::require(at && assets[*at].size.prod() <= assets[i].size.prod());
      fuzz::require(assets[i].twin_group.empty() == assets.twinsOf(i).empty());
    }
  });
  return 0;
}
