# Writes a C source with the text of every study in data/studies, for `ricochet examples`.
file(GLOB studies CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/data/studies/*.yaml)
set(entries "")
foreach(study IN LISTS studies)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${study})
  get_filename_component(name ${study} NAME_WE)
  file(READ ${study} text)
  string(REPLACE "\\" "\\\\" text "${text}")
  string(REPLACE "\"" "\\\"" text "${text}")
  string(REPLACE "\n" "\\n\"\n     \"" text "${text}")
  string(APPEND entries "    {\"${name}\",\n     \"${text}\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/examples_text.c @ONLY CONTENT
"/* Generated from data/studies. */
#include \"command/examples.h\"

const example examples[] = {
@entries@    {0, 0}};
")
