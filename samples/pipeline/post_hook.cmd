@echo off
rem Compensates a program that a post-processor has written, with the counterflex.toml in the program's folder or above.
rem   post_hook.cmd PROGRAM [OPTION of counterflex...]
rem counterflex.exe is beside this file. If it fails, the file PROGRAM.FAILED has the message, for callers that do not read the
rem exit status. The next run that succeeds removes this file.
setlocal DisableDelayedExpansion
if "%~1"=="" (
  echo post_hook.cmd: name the program 1>&2
  exit /b 2
)
"%~dp0counterflex.exe" compensate --quiet %* 2>"%~1.FAILED" >nul
set status=%errorlevel%
if %status%==0 (
  del "%~1.FAILED"
) else (
  type "%~1.FAILED" 1>&2
)
exit /b %status%
