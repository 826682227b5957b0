"""numba's compiler with less around it: what steps and their helpers do not need is left out.

A third of numba's time goes into passes for closures, arrays and literals, of which there are none here; another third
into making machine code of helpers that is never run, as each is compiled into the steps that call it. NOTE: these are
numba's inner parts, which may change from one version to the next: ``compiling`` goes on without them where they fail,
and says so.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba.core import typed_passes, untyped_passes
from numba.core.compiler import Compiler, CompilerBase
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager, _pass_registry, register_pass
from numba.core.environment import lookup_environment
from numba.core.errors import NumbaError
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature

from opsim.engine.fast_engine.machine.libraries import HelperLibrary, StepLibrary
from opsim.engine.fast_engine.machine.slow import say
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


@register_pass(mutates_CFG=True, analysis_only=False)
class StepLowering(typed_passes.NativeLowering):
    """To machine code, of which an object file can be kept."""

    _name = "step_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = StepLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return bool(super().run_pass(state))


@register_pass(mutates_CFG=True, analysis_only=False)
class HelperLowering(typed_passes.NativeLowering):
    """To LLVM code, and no further."""

    _name = "helper_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = HelperLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return bool(super().run_pass(state))


class Passes(PassManager):
    """Run one after the other. NOTE: numba's own way writes down what each is given, for those who listen: nobody."""

    def run(self, state: Any) -> None:
        for kind, _ in self.passes:
            one = _pass_registry.get(kind).pass_inst
            one.analysis = self._analysis
            for part in (one.run_initialization, one.run_pass, one.run_finalizer):
                part(state)


def _passes(name: str, lowering: Any) -> list[PassManager]:
    manager = Passes(name)
    for one in (*PASSES, lowering, typed_passes.NoPythonBackend):
        manager.add_pass(one)
    manager.finalize()
    return [manager]


HELPER_PASSES, STEP_PASSES = _passes("helper", HelperLowering), _passes("step", StepLowering)


class HelperCompiler(CompilerBase):
    def define_pipelines(self) -> list[PassManager]:
        return HELPER_PASSES


class StepCompiler(CompilerBase):
    def define_pipelines(self) -> list[PassManager]:
        return STEP_PASSES


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
        except (NumbaError, NotImplementedError) as error:
            few, self._compiler.pipeline_class = self._compiler.pipeline_class, Compiler
            try:
                made = self._compiler._compile_core(args, answer)
            finally:
                self._compiler.pipeline_class = few
            say(self.py_func.__qualname__, "compiled by all of numba's passes, which takes longer", error)
            return made


def options(**more: bool) -> dict[str, Any]:
    """As ``numba.njit`` gives them to a function that Python does not call."""
    said = {"nopython": True, "nogil": True, "boundscheck": None}
    return {**said, "no_cpython_wrapper": True, "no_cfunc_wrapper": True, **more}


def helper(**more: bool) -> Callable[[Callable], Any]:
    """What makes of a function one that is compiled into each that calls it."""

    def made(function: Callable) -> Any:
        return Helper(py_func=function, locals={}, targetoptions=options(**more), pipeline_class=HelperCompiler)

    return made


def compiled_step(signature: Any, function: Callable) -> Code:
    """The machine code of a function compiled for one signature.

    Raises LookupError where it refers to something of this process: such code cannot be kept.
    """
    made = Helper(py_func=function, locals={}, targetoptions=options(), pipeline_class=StepCompiler)
    made.compile(signature)
    return _code(made.overloads[tuple(signature.args)])


def _code(result: Any) -> Code:
    """Machine code that refers to nothing of this process but functions known by their names."""
    library, name = result.library, result.fndesc.llvm_func_name
    module = library._final_module
    outside = [one.name for one in (*module.functions, *module.global_variables) if one.is_declaration]
    environments = [one.name for one in module.global_variables if one.name.startswith(ENVIRONMENT)]
    known = [found for name in environments if (found := lookup_environment(name)) is not None]
    if library.has_dynamic_globals or any(one.consts for one in known):
        raise LookupError(f"{name} refers to objects of Python")
    return Code(name, tuple(one for one in outside if not one.startswith("llvm.")), library.machine_code)
