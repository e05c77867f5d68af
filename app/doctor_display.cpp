#include "app/doctor.hpp"
#include "drivers/lcm_url.hpp"

namespace hitchview::app {
namespace {

Diagnosis CheckStream(const DoctorSubject& subject) {
    const PublishConfig& publish = subject.rig.config.publish;
    if (!subject.MakesPanoramas()) return {.what = "hitchview.service is not active"};
    if (!subject.rig.is_installed)
        return {.what = std::string("the service runs ") + kInstalledRig + ", not this rig file"};
    if (!drivers::IsMulticastUrl(publish.url))
        return {.what = publish.url + " is no multicast network"};
    if (!subject.machine.multicast_source()) return {.what = "after lcm_multicast_route"};
    const auto heard = subject.machine.hear(publish.url, publish.panorama_channel);
    const std::string where = publish.panorama_channel + " at " + publish.url;
    const std::string restart =
        "systemctl restart hitchview (the rig file may have been changed since its start); "
        "journalctl --unit hitchview --lines 50 tells more";
    if (!heard) return {Finding::kBad, where + ": " + heard.error(), restart};
    const std::string within = std::to_string(heard.value().within.count()) + " ms";
    if (heard.value().messages == 0)
        return {Finding::kBad, "no panorama on " + where + " within " + within, restart};
    return {Finding::kGood, std::to_string(heard.value().messages) + " panoramas on " + where +
                                " within " + within};
}

}  // namespace

std::vector<DoctorCheck> DisplayChecks(const DoctorCase& subject) {
    return {{"display_stream",
             [subject] { return CheckStream(*subject); },
             {"rig_file", "lcm_receive_buffer", "lcm_loopback_multicast", "lcm_multicast_route",
              "lcm_delivery", "camera_devices", "camera_access", "service"}}};
}

}  // namespace hitchview::app
