#include "io/octomap_file.hpp"

#include <sstream>

#include "mapping/octomap_adapter.hpp"
#include "mapping/surface_cloud.hpp"
#include "projection/error.hpp"

namespace thermovox {
namespace {

/// Puts what a tree wrote into a stream into a file; OctoMap's own writers check no write.
void writeStream(const std::filesystem::path& path, const std::ostringstream& stream, Existing existing) {
  AtomicFile file(path, existing);
  file.write(stream.view());
  file.commit();
}

/// The bytes of OctoMap's writeBinary, node by node: its own two ways to write a whole tree speak on stderr,
/// the one always, the other in builds with assertions.
void writeBinary(octomap::OcTree& tree, std::ostream& stream) {
  tree.toMaxLikelihood();
  tree.prune();
  stream << "# Octomap OcTree binary file\n"
            "# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
         << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
         << "\ndata\n";
  if (tree.getRoot() != nullptr) tree.writeBinaryNode(stream, tree.getRoot());
}

}  // namespace

void writeBt(const std::filesystem::path& path, const ThermalMap& map, Existing existing) {
  checkOutput(path, existing);
  std::ostringstream stream;
  writeBinary(*toOcTree(map), stream);
  writeStream(path, stream, existing);
}

void writeOt(const std::filesystem::path& path, const ThermalMap& map, const ColourScale& scale,
             Existing existing) {
  checkOutput(path, existing);
  const TemperatureSpan span = spanOf(surfaceCloud(map), scale);
  const auto inOctomap = [](const Rgb& rgb) { return octomap::ColorOcTreeNode::Color(rgb.r, rgb.g, rgb.b); };
  const auto colour = [&](const SurfaceCell& cell) {
    return inOctomap(cell.observations > 0 ? colourOf(cell.mean(), span, scale.palette) : kUnknownColour);
  };
  const auto tree = toColorOcTree(map, colour, inOctomap(kUnknownColour));
  std::ostringstream stream;
  if (!tree->write(stream)) throw DataError(path.string() + ": OctoMap cannot write this map");
  writeStream(path, stream, existing);
}

}  // namespace thermovox
