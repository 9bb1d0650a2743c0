# cmake -DDIR=folder -P harden_lcm_types.cmake: makes lcm-gen's C++ decoders distrust a message.
# lcm-gen 1.3.1 resizes a vector to whatever count the message states before it looks at how many
# bytes are left: a damaged count allocates gigabytes, and one whose size in bytes overflows an int
# passes the later check and reads past the buffer. No element of ours takes less than a byte, so a
# count above the bytes left is refused here. A string's length counts its closing zero: at least 1.
# Elements of a struct are larger in memory than on the wire: a vector of them grows as they are read,
# so that a message takes memory in proportion to its length.
file(GLOB headers ${DIR}/*.hpp)
foreach(header ${headers})
  file(READ ${header} text)
  string(REGEX REPLACE
    "(this->[A-Za-z0-9_]+\\.resize\\((this->[A-Za-z0-9_]+)\\))"
    "if (\\2 < 0 || \\2 > maxlen - pos) return -1; \\1"
    text "${text}")
  string(REGEX REPLACE
    "if\\((__[A-Za-z0-9_]+) > maxlen - pos\\)"
    "if (\\1 < 1 || \\1 > maxlen - pos)"
    text "${text}")
  string(REGEX REPLACE
    "(this->[A-Za-z0-9_]+)\\.resize\\((this->[A-Za-z0-9_]+)\\);\n( *for \\(int a0 = 0; a0 < this->[A-Za-z0-9_]+; a0\\+\\+\\) {)"
    "\\1.clear();\n\\3 \\1.resize(a0 + 1);"
    text "${text}")
  file(WRITE ${header} "${text}")
endforeach()
