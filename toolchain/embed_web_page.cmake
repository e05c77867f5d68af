# Writes the files of the page into a source file of C++:
#   cmake -D FOLDER=<app/web_page> -D FILES=<name;name...> -D OUTPUT=<file.cpp> -P toolchain/embed_web_page.cmake
cmake_minimum_required(VERSION 3.22)

set(type_html "text/html; charset=utf-8")
set(type_css "text/css; charset=utf-8")
set(type_js "text/javascript; charset=utf-8")
set(type_svg "image/svg+xml")

set(arrays "")
set(entries "")
foreach(name IN LISTS FILES)
    file(READ "${FOLDER}/${name}" hex HEX)
    file(SHA256 "${FOLDER}/${name}" hash)
    string(SUBSTRING "${hash}" 0 16 tag)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(REGEX REPLACE "[^a-z0-9]" "_" identifier "${name}")
    string(REGEX REPLACE "^.*\\.([a-z]+)$" "\\1" extension "${name}")
    string(APPEND arrays "constexpr std::uint8_t ${identifier}[] = {${bytes}};\n")
    string(APPEND entries "    {\"${name}\", \"${type_${extension}}\", \"\\\"${tag}\\\"\", ${identifier}},\n")
endforeach()

file(WRITE "${OUTPUT}" "#include \"app/web_page_files.hpp\"

namespace hitchview::app {
namespace {

${arrays}
constexpr WebPageFile kFiles[] = {
${entries}};

}  // namespace

std::span<const WebPageFile> WebPageFiles() {
    return kFiles;
}

}  // namespace hitchview::app
")
