#pragma once

#include <string>

#include "app/doctor_machine.hpp"

namespace hitchview::app {

/// The interface by which /proc/net/route sends what goes to LCM's group; empty: it does not tell.
std::string MulticastInterface(const DoctorMachine& machine);

}  // namespace hitchview::app
