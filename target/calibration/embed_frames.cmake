# Writes `output`, the C++ source with the bytes of `files`:
#   cmake -Doutput=FILE -Dfiles=FILE;FILE… -P embed_frames.cmake
set(text "#include \"embedded_frames.h\"\n\nnamespace tether::calibration {\nnamespace {\n")
set(list "")
set(count 0)
foreach(file IN LISTS files)
  file(READ "${file}" hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND text "constexpr unsigned char kFrame${count}[] = {${bytes}};\n")
  string(APPEND list "  {kFrame${count}, sizeof kFrame${count}},\n")
  math(EXPR count "${count} + 1")
endforeach()
string(APPEND text "}  // namespace\n\nconst EmbeddedFile kEmbeddedFrames[] = {\n${list}};\n"
  "const std::size_t kEmbeddedFrameCount = ${count};\n\n}  // namespace tether::calibration\n")
file(WRITE "${output}" "${text}")
