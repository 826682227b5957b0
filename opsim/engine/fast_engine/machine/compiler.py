"""numba's compiler with less around it: what steps and their helpers do not need is left out.

A third of numba's time goes into passes for closures, arrays and literals, of which there are none here; another third
into making machine code of helpers that is never run, as each is compiled into the steps that call it. NOTE: these are
numba's inner parts, which may change from one version to the next: ``compiling`` goes on without them where they fail.
"""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import llvmlite.binding as llvm
from numba.core import typed_passes, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompilerBase
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.environment import lookup_environment
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature

from opsim.engine.fast_engine.machine.store import Code

ENVIRONMENT = "_ZN08NumbaEnv"
"""How the names of pointers to Python's objects begin that compiled code may use; steps use none."""
_Dispatcher: Any = CPUDispatcher

PASSES: tuple[Any, ...] = (
    *(untyped_passes.TranslateByteCode, untyped_passes.FixupArgs, untyped_passes.IRProcessing),
    *(untyped_passes.GenericRewrites, untyped_passes.ReconstructSSA),
    *(typed_passes.NopythonTypeInference, typed_passes.PreLowerStripPhis),
    *(typed_passes.NoPythonSupportedFeatureValidation, typed_passes.IRLegalization),
)
"""Before the lowering. NOTE: GenericRewrites is what makes ``x ** 2`` a product, as in all that numba compiles."""


class HelperLibrary(JITCodeLibrary):
    """LLVM code that is only ever linked into that of steps: no machine code is made of it."""

    @property
    def codegen(self) -> Any:
        """For ``get_executable``, which would look for the environment of a function in the machine code."""
        return SimpleNamespace(set_env=lambda _name, _environment: None)

    def get_pointer_to_function(self, name: str) -> int:
        """There is none."""
        return 0

    def _optimize_final_module(self) -> None:
        """Left to the steps."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


class StepLibrary(JITCodeLibrary):
    """Of a step and all helpers compiled into it."""

    def _optimize_final_module(self) -> None:
        """Once, by LLVM's second level: numba's three rounds and its third level took longer and ran no faster.

        NOTE: helpers become the step's own. Names of numba's count functions as a process meets them, so that helpers
        of two processes could share one, and LLVM links all of a name to the first.
        """
        for one in self._final_module.functions:
            if not one.is_declaration and one.linkage == llvm.Linkage.linkonce_odr:
                one.linkage = llvm.Linkage.internal
        wanted = {"opt": 2, "loop_vectorize": False, "slp_vectorize": False}
        manager, builder = self._codegen._module_pass_manager(**wanted)
        manager.run(self._final_module, builder)


@register_pass(mutates_CFG=True, analysis_only=False)
class StepLowering(typed_passes.NativeLowering):
    """To machine code, of which an object file can be kept."""

    _name = "step_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = StepLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class HelperLowering(typed_passes.NativeLowering):
    """To LLVM code, and no further."""

    _name = "helper_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = HelperLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return bool(super().run_pass(state))


def _passes(name: str, state: Any, lowering: Any) -> list[PassManager]:
    manager = PassManager(name)
    for one in (*PASSES, lowering, typed_passes.NoPythonBackend):
        manager.add_pass(one)
    manager.finalize()
    return [manager]


class HelperCompiler(CompilerBase):
    def define_pipelines(self) -> list[PassManager]:
        return _passes("helper", self.state, HelperLowering)


class StepCompiler(CompilerBase):
    def define_pipelines(self) -> list[PassManager]:
        return _passes("step", self.state, StepLowering)


class Helper(_Dispatcher):
    """A function that is compiled into others, without numba's timers, which would be told of each by all around it."""

    @global_compiler_lock
    def compile(self, sig: Any) -> Any:
        args, answer = normalize_signature(sig)
        found = self.overloads.get(tuple(args))
        if found is None:
            if not self._can_compile:
                raise RuntimeError("compilation disabled")
            with self._compiling_counter:
                found = self._made(args, answer)
                self.add_overload(found)
        return found.entry_point

    def _made(self, args: Any, answer: Any) -> Any:
        """With all passes, where the few are not enough."""
        try:
            return self._compiler._compile_core(args, answer)
        except Exception:
            self._compiler.pipeline_class = Compiler
            return self._compiler.compile(args, answer)


def options(**more: bool) -> dict[str, Any]:
    """As ``numba.njit`` gives them to a function that Python does not call."""
    said = {"nopython": True, "nogil": True, "boundscheck": None}
    return {**said, "no_cpython_wrapper": True, "no_cfunc_wrapper": True, **more}


def helper(**more: bool) -> Callable[[Callable], Any]:
    """What makes of a function one that is compiled into each that calls it."""

    def made(function: Callable) -> Any:
        return Helper(py_func=function, locals={}, targetoptions=options(**more), pipeline_class=HelperCompiler)

    return made


def compiled_step(signature: Any, function: Callable) -> tuple[int, object, Code | None]:
    """Address of a function compiled for one signature, what its machine code lives with, and that code."""
    made = Helper(py_func=function, locals={}, targetoptions=options(), pipeline_class=StepCompiler)
    made.compile(signature)
    result = made.overloads[tuple(signature.args)]
    at = int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))
    if not at:
        raise LookupError(f"{function.__name__}: compiled, and not found")
    return at, made, _code(result)


def _code(result: Any) -> Code | None:
    """What can be kept: machine code that refers to nothing of this process but functions known by their names."""
    module = result.library._final_module
    outside = [one.name for one in (*module.functions, *module.global_variables) if one.is_declaration]
    environments = [one.name for one in module.global_variables if one.name.startswith(ENVIRONMENT)]
    known = [found for name in environments if (found := lookup_environment(name)) is not None]
    if result.library.has_dynamic_globals or any(one.consts for one in known):
        return None
    needs = tuple(name for name in outside if not name.startswith("llvm."))
    return Code(result.fndesc.llvm_func_name, needs, bytes(result.library._get_compiled_object()))
