#include "algo/field_fit.hpp"

#include <algorithm>
#include <cmath>

namespace hitchview::algo {
namespace {

using Eigen::Vector2f;

constexpr int kSelf = 4;
constexpr int kLeft = 3;
constexpr int kRight = 5;
constexpr int kAbove = 1;
constexpr int kBelow = 7;

/// Weight of a residual, 1 at none (Geman and McClure 1987).
float WeightOf(float squared_residual, double outlier_px) {
    const auto ratio = squared_residual / static_cast<float>(outlier_px * outlier_px);
    return 1 / ((1 + ratio) * (1 + ratio));
}

}  // namespace

FieldFit::FieldFit(const Mesh& mesh, const FieldFitOptions& options)
    : mesh_(mesh), options_(options) {
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Mesh::kVertexCols; ++col) {
            for (int k = 0; k < kNeighbours; ++k) {
                neighbour_[static_cast<std::size_t>(Mesh::Index(row, col))]
                          [static_cast<std::size_t>(k)] = Neighbour(row, col, k);
            }
        }
    }
}

int FieldFit::Neighbour(int row, int col, int k) const {
    const int r = row + k / 3 - 1;
    const int c = mesh_.WrappedColumn(col + k % 3 - 1);
    if (r < 0 || r > Mesh::kRows || c < 0 || c > Mesh::kCols) return -1;
    return Mesh::Index(r, c);
}

void FieldFit::Fit(std::span<const PointMotion> samples, const VertexField& predicted,
                   const VertexScalars& confidence, VertexField& field, VertexScalars& support) {
    for (int solve = 0; solve < options_.solves; ++solve) {
        const double share = std::min(1.0, solve / std::max(1.0, options_.solves - 2.0));
        const double outlier_px = options_.start_outlier_px *
                                  std::pow(options_.outlier_px / options_.start_outlier_px, share);
        Clear();
        AddSamples(samples, outlier_px, field);
        AddPrior(predicted, confidence, field);
        AddMembrane();
        for (int sweep = 0; sweep < options_.sweeps; ++sweep) Sweep(field);
        CloseRing(mesh_, field);
    }
    support = support_;
}

void FieldFit::Clear() {
    for (Stencil& stencil : normal_) stencil.fill(0);
    right_.setZero();
    support_.setZero();
}

void FieldFit::AddSamples(std::span<const PointMotion> samples, double outlier_px,
                          const VertexField& field) {
    for (const PointMotion& sample : samples) AddSample(sample, outlier_px, field);
}

void FieldFit::AddSample(const PointMotion& sample, double outlier_px, const VertexField& field) {
    const MeshPlace place = Locate(mesh_, sample.at_px);
    const Vector2f wanted = sample.motion_px.cast<float>();
    Vector2f now = Vector2f::Zero();
    for (std::size_t a = 0; a < 4; ++a) now += place.share[a] * field.col(place.vertex[a]);
    const float weight = WeightOf((wanted - now).squaredNorm(), outlier_px);
    for (std::size_t a = 0; a < 4; ++a) {
        const int i = mesh_.ring ? FirstColumnOfRing(place.vertex[a]) : place.vertex[a];
        const float pull = weight * place.share[a];
        right_.col(i) += pull * wanted;
        support_(i) += pull;
        for (std::size_t b = 0; b < 4; ++b) {
            // The corners of a cell are neighbours: from a to b in the stencil of a.
            const int down = static_cast<int>(b / 2) - static_cast<int>(a / 2);
            const int across = static_cast<int>(b % 2) - static_cast<int>(a % 2);
            normal_[static_cast<std::size_t>(i)]
                   [static_cast<std::size_t>(kSelf + 3 * down + across)] += pull * place.share[b];
        }
    }
}

void FieldFit::AddPrior(const VertexField& predicted, const VertexScalars& confidence,
                        const VertexField& field) {
    for (int i = 0; i < Mesh::kVertices; ++i) {
        const float change_px2 = (field.col(i) - predicted.col(i)).squaredNorm();
        const float pull = static_cast<float>(options_.memory) * confidence(i) *
                           WeightOf(change_px2, options_.change_px);
        normal_[static_cast<std::size_t>(i)][kSelf] += pull;
        right_.col(i) += pull * predicted.col(i);
    }
}

void FieldFit::AddMembrane() {
    const double width = mesh_.cell_px.x();
    const double height = mesh_.cell_px.y();
    const auto across = static_cast<float>(options_.smoothness * height / width);
    const auto down = static_cast<float>(options_.smoothness * width / height);
    const auto fade = static_cast<float>(options_.smoothness * width * height /
                                         (options_.fade_px * options_.fade_px));
    for (int i = 0; i < Mesh::kVertices; ++i) {
        Stencil& stencil = normal_[static_cast<std::size_t>(i)];
        const auto& neighbour = neighbour_[static_cast<std::size_t>(i)];
        for (const int k : {kLeft, kRight, kAbove, kBelow}) {
            if (neighbour[static_cast<std::size_t>(k)] < 0) continue;
            const float pull = k == kLeft || k == kRight ? across : down;
            stencil[kSelf] += pull;
            stencil[static_cast<std::size_t>(k)] -= pull;
        }
        stencil[kSelf] += fade / (1 + 4 * support_(i));
    }
}

void FieldFit::Sweep(VertexField& field) const {
    for (int row = 0; row < Mesh::kVertexRows; ++row) {
        for (int col = 0; col < Columns(); ++col) {
            const int i = Mesh::Index(row, col);
            const auto at = static_cast<std::size_t>(i);
            Vector2f rest = right_.col(i);
            for (std::size_t k = 0; k < kNeighbours; ++k) {
                if (k == kSelf || neighbour_[at][k] < 0) continue;
                rest -= normal_[at][k] * field.col(neighbour_[at][k]);
            }
            field.col(i) = rest / normal_[at][kSelf];
        }
    }
}

}  // namespace hitchview::algo
