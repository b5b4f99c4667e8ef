#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "projection/colouring_batch.hpp"
#include "projection/occluder.hpp"
#include "projection/rig.hpp"

namespace thermovox {

/// Why a return has no temperature.
enum class Uncoloured { no_camera, no_frame, no_pose_for_frame, outside_image, hidden, unknown_pixel };

/// The temperature that a frame gave a return.
struct FrameColour {
  Colour colour;
  /// 1 for the first return that was coloured by this pixel of this frame, 2 for the second, ... All of them
  /// share the pixel's noise.
  int sample = 1;
  const ThermalView* view = nullptr;  ///< of the frame; until the window drops it
};

/// The thermal frames around the returns at hand. A frame comes in, waits until enough laser data after it is
/// known, is then closed with what may hide things from it, colours returns, and is dropped.
/// One that has no return near it costs nothing but its image while it waits.
class FrameWindow {
 public:
  struct Options {
    Duration limit = Duration::zero();      ///< farthest in time from a return that a frame colours it
    Duration lookahead = Duration::zero();  ///< from a frame's stamp to its closing; at least the limit
  };
  /// Makes what says whether anything stands between a frame and a point.
  using OccluderFor = std::function<std::unique_ptr<Occluder>(const ThermalView& view)>;

  /// The camera must outlive the window.
  FrameWindow(const ThermalCamera& camera, const Options& options);
  ~FrameWindow();

  /// Frames come in the order of their stamps; without a pose (of the camera in the world, at the frame's own
  /// time) a frame colours nothing, and the returns near it say why.
  void add(ThermalFrame frame, const std::optional<Pose>& T_world_camera);

  /// When the oldest open frame is to be closed; nullopt when none is open.
  [[nodiscard]] std::optional<Time> nextDue() const;
  /// Its stamp. Precondition, here and below: nextDue().
  [[nodiscard]] Time nextStamp() const;
  /// Closes it. `occluder_for` is called for what hides things from it; null when no return can ask for it.
  void closeNext(const OccluderFor& occluder_for);

  /// The temperature of a return from the closed frame nearest in time that sees it. A return that the
  /// nearest frame does not see may take it from another within the limit; if none sees it, the nearest says
  /// why.
  [[nodiscard]] std::variant<FrameColour, Uncoloured> colour(const PlacedReturn& placed);
  /// The same for each return of a reading, as if one were asked after the other, but many times faster;
  /// valid until the next call.
  [[nodiscard]] std::span<const std::variant<FrameColour, Uncoloured>> colour(
      std::span<const PlacedReturn> reading);

  /// Forgets closed frames that no return from `earliest` on can ask for.
  void dropBefore(Time earliest);

 private:
  struct Frame;
  struct Nearer;
  using Candidates = std::vector<Frame*>;  ///< the frames that a return may ask, nearest first
  using Answer = std::variant<FrameColour, Uncoloured>;
  /// The returns of a reading that ask one frame.
  struct Question {
    Frame* frame;
    std::vector<std::uint32_t> returns;
  };
  [[nodiscard]] Candidates candidatesAt(Time stamp) const;
  [[nodiscard]] bool areCandidatesAt(const Candidates& candidates, Time stamp) const;
  [[nodiscard]] Answer colourBy(Frame& frame, const PlacedReturn& placed) const;
  void findCandidates(std::span<const PlacedReturn> reading);
  [[nodiscard]] std::vector<Question> questions(std::size_t attempt) const;
  void ask(const Question& question, std::span<const PlacedReturn> reading, std::size_t attempt);

  const ThermalCamera& camera_;
  Options options_;
  std::deque<std::unique_ptr<Frame>> frames_;  ///< ascending; the closed ones first
  std::size_t closed_ = 0;

  ColouringBatch batch_;
  std::vector<Candidates> candidates_;        ///< those of the reading at hand
  std::vector<std::uint32_t> candidates_of_;  ///< which of them are each return's
  std::vector<Answer> answers_;               ///< to each return
  std::vector<Frame*> coloured_by_;           ///< null while nothing has coloured it
};

}  // namespace thermovox
