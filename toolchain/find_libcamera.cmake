# Optional: cameras that only libcamera drives. Without it everything else builds, and such a camera cannot be opened.
option(HITCHVIEW_LIBCAMERA "Build the libcamera driver where libcamera 0.0.3 or later is installed" ON)

set(HITCHVIEW_HAS_LIBCAMERA OFF)
if(HITCHVIEW_LIBCAMERA)
    find_package(PkgConfig QUIET)
    if(PkgConfig_FOUND)
        pkg_check_modules(LIBCAMERA QUIET IMPORTED_TARGET libcamera>=0.0.3)
        if(LIBCAMERA_FOUND)
            set(HITCHVIEW_HAS_LIBCAMERA ON)
        endif()
    endif()
endif()
message(STATUS "libcamera: ${HITCHVIEW_HAS_LIBCAMERA} ${LIBCAMERA_VERSION}")
