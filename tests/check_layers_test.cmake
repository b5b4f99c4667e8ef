# check_layers.cmake itself: it takes the arrows that are allowed and refuses each one that is not.
# Run: cmake -DCHECK=<check_layers.cmake> -DWORK=<empty folder> -P check_layers_test.cmake

# plant(<from> <to>): a tree of one file, <from>/planted.cpp, that includes a header of <to>.
function(plant from to)
  file(REMOVE_RECURSE ${WORK})
  file(WRITE ${WORK}/${from}/planted.cpp "#include <vector>\n#include \"${to}/some.hpp\"\n")
endfunction()

function(expect verdict from to)
  plant(${from} ${to})
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${WORK} -P ${CHECK}
    RESULT_VARIABLE code ERROR_VARIABLE message OUTPUT_QUIET)
  if(verdict STREQUAL "allowed" AND NOT code EQUAL 0)
    message(SEND_ERROR "${from} -> ${to} is an arrow of the project, but was refused: ${message}")
  elseif(verdict STREQUAL "refused" AND (code EQUAL 0 OR NOT message MATCHES "${from}/planted.cpp"))
    message(SEND_ERROR "${from} -> ${to} should have been refused, naming the file; exit code ${code}: ${message}")
  endif()
endfunction()

foreach(module projection mapping calibration io apps)
  expect(allowed ${module} ${module})
  expect(refused ${module} tests)
endforeach()
foreach(module mapping calibration io apps)
  expect(allowed ${module} projection)
  expect(refused projection ${module})
endforeach()
foreach(module projection mapping calibration io)
  expect(allowed apps ${module})
  expect(refused ${module} apps)
endforeach()
expect(allowed io mapping)
expect(refused mapping io)
expect(refused mapping calibration)
expect(refused calibration mapping)
expect(refused calibration io)
expect(refused io calibration)
file(REMOVE_RECURSE ${WORK})
