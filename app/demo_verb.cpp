#include "app/demo_verb.hpp"
namespace hitchview::app { int DemoVerb(const DemoOptions&, const std::atomic<bool>&) { return 3; } }
