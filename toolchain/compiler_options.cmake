# One interface target carries the language level, the warnings and the sanitizers of our own code.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
    set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

set(HITCHVIEW_SANITIZE "" CACHE STRING "Sanitizers of our own code, for example address,undefined")

add_library(hitchview_options INTERFACE)
target_include_directories(hitchview_options INTERFACE ${PROJECT_SOURCE_DIR})
# No FMA contraction: one recording gives one panorama, bit for bit, on every x86 level.
target_compile_options(hitchview_options INTERFACE
    -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
    $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast> -Werror -ffp-contract=off -fno-math-errno)
if(HITCHVIEW_SANITIZE)
    target_compile_options(hitchview_options INTERFACE -fsanitize=${HITCHVIEW_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(hitchview_options INTERFACE -fsanitize=${HITCHVIEW_SANITIZE})
    target_compile_definitions(hitchview_options INTERFACE HITCHVIEW_SANITIZED)
endif()
