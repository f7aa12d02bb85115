(()=>{var o=()=>new Promise(e=>requestAnimationFrame(()=>setTimeout(e)));window.fpcadPainted=o();})();
