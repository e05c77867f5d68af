# Cross build for arm64 (NVIDIA Jetson) against the sysroot that toolchain/sysroot makes. Programs of the build, lcm-gen among them,
# are this machine's; tests run under qemu.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

# CMake reads this file once more for each of its own trial builds.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HITCHVIEW_SYSROOT)
if(NOT HITCHVIEW_SYSROOT)
    execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/sysroot --cached
        OUTPUT_VARIABLE HITCHVIEW_SYSROOT OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT HITCHVIEW_SYSROOT)
        message(FATAL_ERROR "No arm64 sysroot on this machine yet: toolchain/sysroot makes one")
    endif()
    set(HITCHVIEW_SYSROOT ${HITCHVIEW_SYSROOT} CACHE PATH "What to compile against, and to run with under qemu")
endif()
set(CMAKE_SYSROOT ${HITCHVIEW_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

set(arm64_libraries ${CMAKE_SYSROOT}/usr/lib/aarch64-linux-gnu)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${CMAKE_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${arm64_libraries}/pkgconfig:${CMAKE_SYSROOT}/usr/share/pkgconfig)

# The same binaries wherever checkout and sysroot lie.
foreach(language C CXX)
    set(CMAKE_${language}_FLAGS_INIT "-ffile-prefix-map=${CMAKE_SOURCE_DIR}/= -ffile-prefix-map=${CMAKE_SYSROOT}=")
endforeach()

# A CPU like Orin's Cortex-A78AE: ARMv8.2 without SVE.
find_program(QEMU_AARCH64 NAMES qemu-aarch64 qemu-aarch64-static)
if(QEMU_AARCH64)
    set(CMAKE_CROSSCOMPILING_EMULATOR ${QEMU_AARCH64} -cpu cortex-a76 -L ${CMAKE_SYSROOT})
endif()
