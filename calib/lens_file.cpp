#include "calib/lens_file.hpp"

#include <algorithm>

#include "calib/camera_model_yaml.hpp"
#include "calib/replace_file.hpp"
#include "calib/yaml_map.hpp"

namespace hitchview::calib {
namespace {

std::string Quality(const Intrinsics& lens) {
    const auto used = std::ranges::count_if(lens.views, &ViewOutcome::is_used);
    std::string text = "quality:\n  rms_px: " + ExactText(lens.rms_px);
    if (lens.heldout_rms_px) text += "\n  heldout_rms_px: " + ExactText(*lens.heldout_rms_px);
    text += "\n  views_used: " + std::to_string(used) +
            "\n  views_found: " + std::to_string(lens.views.size()) +
            "\n  board_bulge_m: " + ExactText(lens.bulge_m) + "\n  reasons: [";
    for (std::size_t i = 0; i < lens.reasons.size(); ++i)
        text += (i == 0 ? "" : ", ") + Quoted(lens.reasons[i]);
    return text + "]\n";
}

std::string Sigma(const Intrinsics& lens) {
    const std::vector<double>& s = lens.sigma;
    if (s.empty()) return "";
    std::string text = "sigma:\n  focal_px: " + ExactText({s[0], s[1]}) +
                       "\n  centre_px: " + ExactText({s[2], s[3]}) + "\n  distortion: [";
    for (std::size_t i = 4; i < s.size(); ++i) text += (i == 4 ? "" : ", ") + ExactText(s[i]);
    return text + "]\n";
}

std::string Head(const algo::CameraModel& model, Verdict verdict, const std::string& written_by) {
    return "schema: 1\nverdict: " + std::string(ToString(verdict)) +
           "\nwritten_by: " + Quoted(written_by) + CameraModelText(model, "\n") + "\n";
}

/// What could not be read back does not replace anything.
std::string Replace(const std::filesystem::path& file, const std::string& text) {
    return ReplaceFile(file, text,
                       [](const std::filesystem::path& fresh) { return LoadLens(fresh).error; });
}

/// For people only: whatever stands there is not looked at.
void PassOver(YamlMap& root) {
    (void)root["quality"];
    (void)root["sigma"];
}

LoadedLens ReadWhole(YamlMap root, const YamlComplaints& complaints) {
    LoadedLens loaded;
    int schema = 1;
    std::string written_by;
    root.Required("schema").Read(Range<int>{1, 1}, schema);
    ReadVerdict(root.Required("verdict"), loaded.verdict);
    root.Required("written_by").Read(written_by);
    const algo::CameraModel model = ReadCameraModel(root);
    PassOver(root);
    root.Finish();
    if (complaints.empty()) {
        loaded.model = model;
    } else {
        loaded.error = complaints.Text();
    }
    return loaded;
}

}  // namespace

LoadedLens LoadLens(const std::filesystem::path& file) {
    YamlComplaints complaints(file.string());
    return ReadWhole(LoadYaml(file, complaints), complaints);
}

LoadedLens ParseLens(const std::string& text, const std::string& name) {
    YamlComplaints complaints(name);
    return ReadWhole(ParseYaml(text, complaints), complaints);
}

std::string SaveLens(const Intrinsics& intrinsics, const std::string& written_by,
                     const std::filesystem::path& file) {
    return Replace(file, Head(intrinsics.model, intrinsics.verdict, written_by) +
                             Quality(intrinsics) + Sigma(intrinsics));
}

std::string SaveUncheckedLens(const algo::CameraModel& model, const std::string& written_by,
                              const std::filesystem::path& file) {
    return Replace(file, Head(model, Verdict::kUnchecked, written_by));
}

}  // namespace hitchview::calib
