#include "calibration/rig_bundle.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "calibration/bias_residual.hpp"
#include "calibration/plane_residual.hpp"
#include "calibration/pose_manifold.hpp"
#include "calibration/pose_numbers.hpp"
#include "calibration/reprojection_residual.hpp"

namespace thermovox {
namespace {

constexpr double kHuber = 2.0;  // sigmas
constexpr int kMostIterations = 100;

using CameraNumbers = std::array<double, kCameraParameters>;

/// The numbers of an estimate where Ceres varies them, and the problem about them.
class Bundle {
 public:
  Bundle(const BundleData& data, const RigEstimate& start, const BundleModel& model)
      : data_(data),
        model_(model),
        start_(start),
        laser_(numbersOf(start.T_reference_laser)),
        range_bias_(start.range_bias),
        common_bias_(start.common_range_bias),
        edge_bias_(start.edge_bias) {
    for (const Intrinsics& camera : start.cameras) intrinsics_.push_back(camera.parameters);
    for (const Pose& pose : start.T_camera_reference) camera_poses_.push_back(numbersOf(pose));
    for (const Pose& pose : start.T_reference_board) boards_.push_back(numbersOf(pose));
    range_bias_.resize(boards_.size(), 0.0);
    for (std::size_t capture = 0; capture < data.captures.size(); ++capture) addCapture(capture);
    addSharedPriors();
    setManifolds();
    setLayout();
  }

  BundleFit solve();
  Linearisation linearise();

 private:
  void addCapture(std::size_t capture);
  void addCorners(std::size_t capture, int camera);
  void addPlane(std::size_t capture);
  void addEdges(std::size_t capture);
  [[nodiscard]] EdgeSide widened(EdgeSide side) const;
  void addSharedPriors();
  void setManifolds();
  void setLayout();
  void addGroup(RowGroup::Kind kind, std::size_t first_block, int capture, int camera);
  void hold(double* block, int& place, int size);

  [[nodiscard]] RigEstimate estimate() const;

  template <typename Functor, int kResiduals, int... kBlocks, typename... Blocks>
  void add(const Functor& functor, Blocks... blocks) {
    blocks_.push_back(problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Functor, kResiduals, kBlocks...>(new Functor(functor)), nullptr,
        blocks...));
    rows_ += kResiduals;
  }

  const BundleData& data_;
  const BundleModel& model_;
  RigEstimate start_;
  std::vector<CameraNumbers> intrinsics_;
  std::vector<PoseNumbers> camera_poses_;
  std::vector<PoseNumbers> boards_;
  PoseNumbers laser_;
  std::vector<double> range_bias_;
  double common_bias_;
  double edge_bias_;

  std::unique_ptr<ceres::LossFunction> huber_ = std::make_unique<ceres::HuberLoss>(kHuber);
  ceres::Problem problem_{problemOptions()};
  std::vector<ceres::ResidualBlockId> blocks_;
  std::vector<double*> parameters_;  ///< in the order of the layout
  int rows_ = 0;
  std::vector<RowGroup> groups_;
  TangentLayout layout_;

  static ceres::Problem::Options problemOptions() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }
};

void Bundle::addGroup(RowGroup::Kind kind, std::size_t first_block, int capture, int camera) {
  RowGroup group{.kind = kind, .capture = capture, .camera = camera};
  group.first = groups_.empty() ? 0 : groups_.back().first + groups_.back().count;
  group.count = rows_ - group.first;
  if (blocks_.size() > first_block) groups_.push_back(group);
}

void Bundle::addCapture(std::size_t capture) {
  const int place = static_cast<int>(capture);
  for (int camera = 0; camera < static_cast<int>(intrinsics_.size()); ++camera) {
    const std::size_t first = blocks_.size();
    addCorners(capture, camera);
    addGroup(RowGroup::Kind::corners, first, place, camera);
  }
  if (!data_.captures[capture].plane) return;
  std::size_t first = blocks_.size();
  addPlane(capture);
  addGroup(RowGroup::Kind::plane, first, place, -1);
  first = blocks_.size();
  addEdges(capture);
  addGroup(RowGroup::Kind::edges, first, place, -1);
}

void Bundle::addCorners(std::size_t capture, int camera) {
  const auto index = static_cast<std::size_t>(camera);
  const double factor = model_.corner_factor[index];
  ceres::LossFunction* loss = model_.corner_loss == BundleModel::Loss::huber ? huber_.get() : nullptr;
  for (const CornerObservation& corner : data_.captures[capture].corners) {
    if (corner.camera != camera) continue;
    const Eigen::Matrix2d information = (factor * factor * corner.covariance).inverse();
    const ReprojectionResidual residual{start_.cameras[index].model,
                                        data_.points[static_cast<std::size_t>(corner.point)], corner.pixel,
                                        Eigen::LLT<Eigen::Matrix2d>(information).matrixU()};
    if (camera == 0) {
      using Cost = ceres::AutoDiffCostFunction<ReprojectionResidual, 2, 7, kCameraParameters>;
      blocks_.push_back(problem_.AddResidualBlock(new Cost(new ReprojectionResidual(residual)), loss,
                                                  boards_[capture].data(), intrinsics_[index].data()));
    } else {
      using Cost = ceres::AutoDiffCostFunction<ReprojectionResidual, 2, 7, kCameraParameters, 7>;
      blocks_.push_back(problem_.AddResidualBlock(new Cost(new ReprojectionResidual(residual)), loss,
                                                  boards_[capture].data(), intrinsics_[index].data(),
                                                  camera_poses_[index].data()));
    }
    rows_ += 2;
  }
}

/// The bias's prior is part of the plane's group: without the plane there is no such bias.
void Bundle::addPlane(std::size_t capture) {
  PlaneResidual plane{*data_.captures[capture].plane};
  plane.moments.slope /= model_.plane_factor;
  plane.moments.offset /= model_.plane_factor;
  double* bias = &range_bias_[capture];
  if (model_.common_range_bias_sigma > 0.0) {
    add<PlaneResidualWithCommonBias, 4, 7, 7, 1, 1>(
        PlaneResidualWithCommonBias{plane}, boards_[capture].data(), laser_.data(), bias, &common_bias_);
  } else {
    add<PlaneResidual, 4, 7, 7, 1>(plane, boards_[capture].data(), laser_.data(), bias);
  }
  add<PriorResidual, 1, 1>(PriorResidual{model_.range_bias_sigma}, bias);
}

EdgeSide Bundle::widened(EdgeSide side) const {
  side.offset_sigma = std::hypot(side.offset_sigma, model_.edge_offset_sigma / model_.edge_factor);
  return side;
}

void Bundle::addEdges(std::size_t capture) {
  for (const EdgeSide& side : data_.captures[capture].edges) {
    using Cost = ceres::DynamicAutoDiffCostFunction<EdgeResidual, 15>;
    auto cost = std::make_unique<Cost>(new EdgeResidual{widened(side), model_.edge_factor});
    for (const int size : {7, 7, 1}) cost->AddParameterBlock(size);
    cost->SetNumResiduals(static_cast<int>(side.crossings.size()));
    rows_ += cost->num_residuals();
    blocks_.push_back(problem_.AddResidualBlock(cost.release(), nullptr, boards_[capture].data(),
                                                laser_.data(), &edge_bias_));
  }
}

void Bundle::addSharedPriors() {
  const std::size_t first = blocks_.size();
  if (problem_.HasParameterBlock(&common_bias_))
    add<PriorResidual, 1, 1>(PriorResidual{model_.common_range_bias_sigma}, &common_bias_);
  if (problem_.HasParameterBlock(&edge_bias_))
    add<PriorResidual, 1, 1>(PriorResidual{model_.edge_bias_sigma}, &edge_bias_);
  addGroup(RowGroup::Kind::prior, first, -1, -1);
}

void Bundle::setManifolds() {
  for (std::size_t camera = 0; camera < intrinsics_.size(); ++camera) {
    double* block = intrinsics_[camera].data();
    if (!problem_.HasParameterBlock(block)) continue;
    const std::vector<int>& free = model_.free_intrinsics[camera];
    std::vector<int> held;
    for (int i = 0; i < kCameraParameters; ++i) {
      if (std::find(free.begin(), free.end(), i) == free.end()) held.push_back(i);
    }
    if (free.empty()) {
      problem_.SetParameterBlockConstant(block);
    } else if (!held.empty()) {
      problem_.SetManifold(block, new ceres::SubsetManifold(kCameraParameters, held));
    }
  }
  for (std::vector<PoseNumbers>* poses : {&camera_poses_, &boards_}) {
    for (PoseNumbers& pose : *poses) {
      if (problem_.HasParameterBlock(pose.data())) problem_.SetManifold(pose.data(), new PoseManifold);
    }
  }
  if (!problem_.HasParameterBlock(laser_.data())) return;
  if (data_.laser == LaserKind::beam) {
    problem_.SetManifold(laser_.data(), new BeamManifold);
  } else {
    problem_.SetManifold(laser_.data(), new LaserManifold);
  }
}

void Bundle::hold(double* block, int& place, int size) {
  if (!problem_.HasParameterBlock(block) || problem_.IsParameterBlockConstant(block)) {
    place = -1;
    return;
  }
  place = layout_.size;
  layout_.size += size;
  parameters_.push_back(block);
}

void Bundle::setLayout() {
  hold(laser_.data(), layout_.laser, data_.laser == LaserKind::beam ? 5 : 6);
  layout_.laser_size = layout_.size;
  for (std::size_t camera = 0; camera < intrinsics_.size(); ++camera) {
    hold(intrinsics_[camera].data(), layout_.intrinsics.emplace_back(),
         static_cast<int>(model_.free_intrinsics[camera].size()));
  }
  for (PoseNumbers& pose : camera_poses_) hold(pose.data(), layout_.camera_pose.emplace_back(), 6);
  hold(&common_bias_, layout_.common_bias, 1);
  hold(&edge_bias_, layout_.edge_bias, 1);
  for (double& bias : range_bias_) hold(&bias, layout_.range_bias.emplace_back(), 1);
  for (PoseNumbers& pose : boards_) hold(pose.data(), layout_.board.emplace_back(), 6);
}

RigEstimate Bundle::estimate() const {
  RigEstimate result = start_;
  for (std::size_t i = 0; i < intrinsics_.size(); ++i) result.cameras[i].parameters = intrinsics_[i];
  for (std::size_t i = 0; i < camera_poses_.size(); ++i)
    result.T_camera_reference[i] = poseOf(camera_poses_[i]);
  for (std::size_t i = 0; i < boards_.size(); ++i) result.T_reference_board[i] = poseOf(boards_[i]);
  result.T_reference_laser = poseOf(laser_);
  result.range_bias = range_bias_;
  result.common_range_bias = common_bias_;
  result.edge_bias = edge_bias_;
  return result;
}

/// Boards are eliminated first: each is bound to the few unknowns that all captures share.
BundleFit Bundle::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.max_num_iterations = kMostIterations;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-10;
  options.num_threads = 1;  // the same sums in the same order on every machine
  options.logging_type = ceres::SILENT;
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::vector<double*> all;
  problem_.GetParameterBlocks(&all);
  for (double* block : all) options.linear_solver_ordering->AddElementToGroup(block, 1);
  // Within a group Ceres goes by addresses, which differ from run to run: every block has one of its own.
  int group = 1;
  for (double* block : parameters_) options.linear_solver_ordering->AddElementToGroup(block, ++group);
  for (PoseNumbers& board : boards_) {
    if (problem_.HasParameterBlock(board.data()))
      options.linear_solver_ordering->AddElementToGroup(board.data(), 0);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  return {estimate(), summary.final_cost,
          summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE};
}

Linearisation Bundle::linearise() {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = blocks_;
  options.parameter_blocks = parameters_;
  options.apply_loss_function = false;
  Linearisation result;
  std::vector<double> residuals;
  ceres::CRSMatrix crs;
  problem_.Evaluate(options, nullptr, &residuals, nullptr, &crs);
  result.residuals =
      Eigen::Map<const Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
  result.jacobian = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()), crs.rows.data(),
      crs.cols.data(), crs.values.data());
  result.groups = groups_;
  result.layout = layout_;
  return result;
}

}  // namespace

BundleFit solveBundle(const BundleData& data, const RigEstimate& start, const BundleModel& model) {
  return Bundle(data, start, model).solve();
}

Linearisation linearise(const BundleData& data, const RigEstimate& estimate, const BundleModel& model) {
  return Bundle(data, estimate, model).linearise();
}

}  // namespace thermovox
